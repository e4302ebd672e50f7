import { Checkbox, Select, Slider, Spinner } from "../../../components";
import { useObservable } from "../../../drafts/useObservable";
import { type Part, UNLABELLED_NAME } from "../parts";
import styles from "./ToolOptions.module.css";
import { PATCHES, type PatchMethod, RADIUS, type ToolName, type ToolShelf } from "./toolSettings";
import type { Patches } from "./usePatches";

const METHODS: readonly { value: PatchMethod; label: string }[] = [
  { value: "random_walks", label: "Along creases" },
  { value: "k_means", label: "Even sizes" },
];
const HINTS: Readonly<Record<Exclude<ToolName, "paint" | "patches">, string>> = {
  segment: "Click a segment to give all of it the part in hand.",
  pick: "Click a face to take its part in hand.",
  turn: "Drag to turn, scroll to come nearer, right-drag with Shift to move.",
};
const BRUSH_STEPS = 100;
const ANY = "any";

/** Settings of the tool in hand, in a bar above the stage. */
export function ToolOptions({
  shelf,
  parts,
  patches,
}: {
  shelf: ToolShelf;
  parts: readonly Part[];
  patches: Patches;
}) {
  const { tool } = useObservable(shelf.settings);
  return (
    <fieldset className={styles.options} aria-label="Settings of the tool">
      {tool === "paint" && <PaintOptions shelf={shelf} parts={parts} />}
      {tool === "patches" && <PatchOptions shelf={shelf} patches={patches} />}
      {tool !== "paint" && tool !== "patches" && <p className={styles.hint}>{HINTS[tool]}</p>}
    </fieldset>
  );
}

function PaintOptions({ shelf, parts }: { shelf: ToolShelf; parts: readonly Part[] }) {
  const { radius, hasAngleLimit, angleDegrees, onlyOver } = useObservable(shelf.settings);
  const over = [
    { value: ANY, label: "Anything" },
    { value: "0", label: UNLABELLED_NAME },
    ...parts.map((part) => ({ value: String(part.id), label: part.name })),
  ];
  return (
    <>
      <Slider
        className={styles.slider ?? ""}
        label="Brush"
        value={Math.round(stepOfRadius(radius))}
        min={0}
        max={BRUSH_STEPS}
        format={() => `${(radius * 100).toFixed(1)}%`}
        onChange={(step) => shelf.change({ radius: radiusOfStep(step) })}
      />
      <Checkbox
        label="Angle limit"
        isChecked={hasAngleLimit}
        onChange={(isOn) => shelf.change({ hasAngleLimit: isOn })}
      />
      {hasAngleLimit && (
        <Slider
          className={styles.slider ?? ""}
          label="Angle"
          value={angleDegrees}
          min={5}
          max={90}
          step={5}
          format={(degrees) => `${degrees}°`}
          onChange={(degrees) => shelf.change({ angleDegrees: degrees })}
        />
      )}
      <div className={styles.field}>
        <span aria-hidden="true">Only over</span>
        <Select
          label="Only over"
          isLabelUnseen
          size="small"
          options={over}
          value={onlyOver === null ? ANY : String(onlyOver)}
          onChange={(value) => shelf.change({ onlyOver: value === ANY ? null : Number(value) })}
        />
      </div>
    </>
  );
}

function PatchOptions({ shelf, patches }: { shelf: ToolShelf; patches: Patches }) {
  const { nPatches, method } = useObservable(shelf.settings);
  return (
    <>
      <Slider
        className={styles.slider ?? ""}
        label="Patches"
        value={nPatches}
        {...PATCHES}
        onChange={(n) => shelf.change({ nPatches: n })}
      />
      <div className={styles.field}>
        <span aria-hidden="true">Method</span>
        <Select
          label="Method"
          isLabelUnseen
          size="small"
          options={METHODS}
          value={method}
          onChange={(value) => shelf.change({ method: value })}
        />
      </div>
      <span className={styles.state} role="status">
        {patches.isCutting && <Spinner label="Cutting…" />}
        {patches.why !== null && <span className={styles.why}>{patches.why}</span>}
      </span>
    </>
  );
}

/** The slider is even in how the size looks: each step the same factor. */
function radiusOfStep(step: number): number {
  const radius = RADIUS.min * (RADIUS.max / RADIUS.min) ** (step / BRUSH_STEPS);
  return Number(radius.toPrecision(3));
}

function stepOfRadius(radius: number): number {
  return (BRUSH_STEPS * Math.log(radius / RADIUS.min)) / Math.log(RADIUS.max / RADIUS.min);
}
