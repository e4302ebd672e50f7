import { Plus } from "lucide-react";
import { classes, IconButton } from "../../../components";
import { useObservable } from "../../../drafts/useObservable";
import { type Desk, MAX_HELD } from "../desk/desk";
import styles from "./HeldShapes.module.css";

/** Shapes in the person's hands, to go from one to the other, or take one more. */
export function HeldShapes({ desk }: { desk: Desk }) {
  const { shapes, current } = useObservable(desk.state);
  return (
    <fieldset className={styles.held} aria-label="Shapes in hand">
      {shapes.map((shape) => (
        <button
          key={shape.shapeId}
          type="button"
          className={classes(styles.shape, shape === current && styles.current)}
          aria-pressed={shape === current}
          title={shape.lease.source_key}
          onClick={() => desk.show(shape)}
        >
          {shape.lease.source_key}
        </button>
      ))}
      {shapes.length < MAX_HELD && (
        <IconButton
          label="Take another shape"
          icon={<Plus />}
          size="small"
          onClick={() => void desk.takeNext()}
        />
      )}
    </fieldset>
  );
}
