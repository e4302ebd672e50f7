import { Check, CircleAlert, Eye } from "lucide-react";
import { memo } from "react";
import { classes } from "../../../components";
import { nameOf, pictureOf, type ShapeRow, shownVersion } from "../rows/shapeRows";
import type { Shown, TileSize } from "../view/tableView";
import styles from "./ShapeTile.module.css";
import { initials, STATE_WORDS, scoreText, stageWords, tileWords } from "./stateWords";
import { TilePicture } from "./TilePicture";

export interface TileLook {
  readonly shown: Shown;
  readonly size: TileSize;
  /** Of the score that the list is ordered by; null in other orders. */
  readonly scoreName: string | null;
  /** Changes when parts or their colours do, and with them every picture. */
  readonly partsVersion: string;
}

export interface ShapeTileProps {
  readonly row: ShapeRow;
  readonly place: number;
  readonly column: number;
  readonly look: TileLook;
  readonly isChosen: boolean;
  readonly isCursor: boolean;
}

export const tileId = (place: number) => `shape-tile-${place}`;

/** One shape: its picture, its name, where it stands. Clicks are the grid's. */
export const ShapeTile = memo(function ShapeTile(props: ShapeTileProps) {
  const { row, place, column, look, isChosen, isCursor } = props;
  const { name } = nameOf(row.source_key);
  return (
    // biome-ignore lint/a11y/useFocusableInteractive: the grid keeps the focus and names the active cell
    // biome-ignore lint/a11y/useSemanticElements: a table cannot be drawn in part
    <div
      role="gridcell"
      id={tileId(place)}
      data-place={place}
      data-state={row.state}
      aria-colindex={column + 1}
      aria-selected={isChosen}
      aria-label={tileWords(row, look.scoreName, Date.now())}
      className={classes(
        styles.tile,
        row.state === "confirmed" && styles.confirmed,
        isChosen && styles.chosen,
        isCursor && styles.cursor,
      )}
    >
      <div className={styles.frame}>
        <TilePicture
          address={pictureOf(row, look.shown, look.partsVersion)}
          isFailed={row.state === "failed"}
        />
        <span className={styles.tick} data-tick aria-hidden="true">
          {isChosen && <Check strokeWidth={3} />}
        </span>
        <Marks row={row} />
      </div>
      <div className={styles.caption}>
        <p className={styles.name} title={row.source_key}>
          {name}
        </p>
        {look.size !== "s" && <Facts row={row} look={look} />}
      </div>
    </div>
  );
});

function Marks({ row }: { row: ShapeRow }) {
  const holder = row.held_by.find((each) => Date.parse(each.expires_at) > Date.now());
  return (
    <span className={styles.marks}>
      {holder && (
        <span className={styles.holder} title={`${holder.name} is working on it`}>
          {initials(holder.name)}
        </span>
      )}
      {row.failed_stage !== null && (
        <span className={styles.failure} title={`${stageWords(row.failed_stage)} failed`}>
          <CircleAlert aria-hidden="true" />
        </span>
      )}
      {row.state === "review" && (
        <span className={styles.review} title="Its labels wait for a second look">
          <Eye aria-hidden="true" />
        </span>
      )}
      {row.state === "confirmed" && (
        <span
          className={styles.done}
          title={row.author_name ? `Confirmed by ${row.author_name}` : "Confirmed"}
        >
          <Check strokeWidth={3} aria-hidden="true" />
        </span>
      )}
    </span>
  );
}

function Facts({ row, look }: { row: ShapeRow; look: TileLook }) {
  const version = row.model_version ?? shownVersion(row, look.shown);
  return (
    <p className={styles.facts}>
      <span className={styles.state}>{STATE_WORDS[row.state]}</span>
      {row.score !== null && look.scoreName !== null && (
        <span className={styles.score} title={scoreTitle(row, look.scoreName)}>
          {scoreText(row.score)}
        </span>
      )}
      {version !== null && (
        <span className={styles.version} title={`From model ${version}`}>
          m{version}
        </span>
      )}
    </p>
  );
}

function scoreTitle(row: ShapeRow, scoreName: string): string {
  const score = `${scoreName} ${row.score}`;
  return row.model_version === null ? score : `${score}, from model ${row.model_version}`;
}
