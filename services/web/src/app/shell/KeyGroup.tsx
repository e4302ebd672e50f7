import { Fragment } from "react";
import styles from "./KeyGroup.module.css";

/** What is pressed, such as "Shift+arrows" or "G then T", and what it does. */
export type KeyRow = readonly [keys: string, meaning: string];

const THEN = " then ";

/** Some keys of a sheet, under a heading. */
export function KeyGroup({ heading, rows }: { heading: string; rows: readonly KeyRow[] }) {
  return (
    <section className={styles.group}>
      <h3 className={styles.heading}>{heading}</h3>
      <dl>
        {rows.map(([keys, meaning]) => (
          <div key={meaning} className={styles.row}>
            <dt>{meaning}</dt>
            <dd>
              {keys.split(THEN).map((key, at) => (
                <Fragment key={key}>
                  {at > 0 && THEN}
                  <kbd>{key}</kbd>
                </Fragment>
              ))}
            </dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
