import { Dialog } from "../../../components";
import styles from "./ShortcutSheet.module.css";
import { SHORTCUTS } from "./shortcuts";

const GROUPS = ["Tools", "Parts", "Change", "Shapes", "View"] as const;
const OF_A_VIEW: readonly (readonly [string, string])[] = [
  ["Arrows", "Turn the shape"],
  ["Shift+arrows", "Move it"],
  ["+ −", "Nearer, farther"],
  ["Right button", "Turn, tool in hand"],
  ["Two fingers", "Move and zoom"],
];

/** Every key of the workbench, from the table that also runs them. */
export function ShortcutSheet({ onClose }: { onClose: () => void }) {
  return (
    <Dialog title="Keys of the workbench" size="wide" onClose={onClose}>
      <div className={styles.groups}>
        {GROUPS.map((group) => (
          <section key={group} className={styles.group}>
            <h3 className={styles.heading}>{group}</h3>
            <dl>
              {SHORTCUTS.filter((shortcut) => shortcut.group === group).map(({ what, shown }) => (
                <Row key={what} what={what} shown={shown} />
              ))}
            </dl>
          </section>
        ))}
        <section className={styles.group}>
          <h3 className={styles.heading}>In a view</h3>
          <dl>
            {OF_A_VIEW.map(([shown, what]) => (
              <Row key={what} what={what} shown={shown} />
            ))}
          </dl>
        </section>
      </div>
    </Dialog>
  );
}

function Row({ what, shown }: { what: string; shown: string }) {
  return (
    <div className={styles.row}>
      <dt>{what}</dt>
      <dd>
        <kbd>{shown}</kbd>
      </dd>
    </div>
  );
}
