import { useState } from "react";
import { Input } from "../components";
import { whole } from "../components/numbers";
import { PutFirstButton } from "../rooms/table/actions/PutFirstButton";
import styles from "./EmbeddingMap.module.css";

/** What the service takes of shapes to choose from. */
const MOST_TO_CHOOSE_FROM = 5_000;
const MOST_CHOSEN = 500;
const SUGGESTED = 10;

/** Has some of the shapes that were drawn around labelled first: as far apart as can be, so that they are unlike. */
export function SpreadOut(props: { readonly collectionId: number; readonly shapeIds: readonly number[] }) {
  const { collectionId, shapeIds } = props;
  const [wanted, setWanted] = useState(Math.min(SUGGESTED, shapeIds.length));
  const most = Math.min(MOST_CHOSEN, shapeIds.length);
  const isValid = Number.isInteger(wanted) && wanted >= 1 && wanted <= most;
  // Too many to send: every so-manieth of them, which is as spread out as they are.
  const step = Math.ceil(shapeIds.length / MOST_TO_CHOOSE_FROM);
  return (
    <div className={styles.spread}>
      <Input
        label={`Of these ${whole(shapeIds.length)}, spread out`}
        type="number"
        min={1}
        max={most}
        value={Number.isNaN(wanted) ? "" : wanted}
        onChange={(event) => setWanted(event.target.valueAsNumber)}
      />
      <PutFirstButton
        collectionId={collectionId}
        shapeIds={shapeIds.filter((_, i) => i % step === 0)}
        spread={wanted}
        isDisabled={!isValid}
      />
    </div>
  );
}
