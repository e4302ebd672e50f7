import { useMemo } from "react";
import { count, short, whole } from "../../../components/numbers";
import { useObservableOr } from "../../../drafts/useObservable";
import { partShares } from "../../../labels/partShares";
import { keyOfPart, type Part, UNLABELLED_NAME } from "../parts";
import type { OpenShape } from "../shape/openShape";
import styles from "./PartsList.module.css";

export interface PartsListProps {
  parts: readonly Part[];
  /** In hand. */
  part: number;
  open: OpenShape | null;
  onPick: (part: number) => void;
}

/** The parts to give, with how much of the shape each has. Arrow keys or numbers choose. */
export function PartsList({ parts, part, open, onPick }: PartsListProps) {
  const version = useObservableOr(open?.version, 0);
  // biome-ignore lint/correctness/useExhaustiveDependencies: labels change in place; the version says when
  const shares = useMemo(
    () => (open === null ? new Map() : partShares(open.model.mesh, open.labels)),
    [open, version],
  );
  const inHand = parts.find((each) => each.id === part);
  const rows = [
    ...parts.map((each, place) => ({ ...each, keys: keyOfPart(place) })),
    { id: 0, name: UNLABELLED_NAME, colour: "var(--unlabelled)", gloss: "Takes labels away.", keys: "E" },
  ];
  return (
    <fieldset className={styles.parts}>
      <legend className={styles.legend}>
        <span>Parts</span>
        <span className={styles.faces}>Faces</span>
        <span className={styles.share}>Area</span>
      </legend>
      {rows.map(({ id, name, colour, gloss, keys }) => {
        const share = shares.get(id) ?? { nFaces: 0, area: 0 };
        return (
          <label key={id} className={styles.row} title={titleOf(name, gloss, share.nFaces)}>
            <input
              type="radio"
              name="part"
              className={styles.radio}
              checked={id === part}
              onChange={() => onPick(id)}
            />
            <span className={styles.swatch} style={{ background: colour }} />
            <span className={styles.name}>{name}</span>
            <span className={styles.faces}>{open === null ? "" : facesInShort(share.nFaces)}</span>
            <span className={styles.share}>{open === null ? "" : `${(100 * share.area).toFixed(1)}%`}</span>
            <span className={styles.key} aria-hidden="true">
              {keys !== null && <kbd>{keys}</kbd>}
            </span>
          </label>
        );
      })}
      {inHand !== undefined && inHand.gloss !== "" && <p className={styles.gloss}>{inHand.gloss}</p>}
    </fieldset>
  );
}

function titleOf(name: string, gloss: string, nFaces: number): string {
  return [name, gloss, count(nFaces, "face")].filter((each) => each !== "").join("\n");
}

/** In a narrow column; the title has the whole number. */
function facesInShort(nFaces: number): string {
  return nFaces < 10_000 ? whole(nFaces) : short(nFaces);
}
