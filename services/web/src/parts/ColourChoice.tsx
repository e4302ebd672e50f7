import { TriangleAlert } from "lucide-react";
import { classes, Field } from "../components";
import { colourWarning, SUGGESTED_COLOURS } from "./contrast";
import styles from "./Parts.module.css";

export interface ColourChoiceProps {
  readonly colour: string;
  /** Names and colours of the other parts. */
  readonly others: ReadonlyMap<string, string>;
  onChange(colour: string): void;
}

/** A colour: one of those that stay apart for colour-blind people, or any, with a warning where it does not. */
export function ColourChoice({ colour, others, onChange }: ColourChoiceProps) {
  const warning = colourWarning(colour, others);
  const taken = new Set([...others.values()].map((each) => each.toLowerCase()));
  const free = SUGGESTED_COLOURS.filter((each) => !taken.has(each.toLowerCase()));
  return (
    <div>
      <Field label="Colour">
        {(control) => (
          <span className={styles.colours}>
            <input
              {...control}
              type="color"
              className={styles.picker}
              value={colour.toLowerCase()}
              onChange={(event) => onChange(event.target.value.toUpperCase())}
            />
            {free.map((each) => (
              <button
                key={each}
                type="button"
                className={classes(
                  styles.suggestion,
                  each.toLowerCase() === colour.toLowerCase() && styles.taken,
                )}
                style={{ background: each }}
                aria-label={`Colour ${each}`}
                aria-pressed={each.toLowerCase() === colour.toLowerCase()}
                onClick={() => onChange(each)}
              />
            ))}
          </span>
        )}
      </Field>
      <p className={styles.warning} role="status">
        {warning && (
          <>
            <TriangleAlert aria-hidden="true" /> {warning}
          </>
        )}
      </p>
    </div>
  );
}
