import { useMe } from "../../../app/session/MeContext";
import { KeyGroup, type KeyRow } from "../../../app/shell/KeyGroup";
import { roomKeyRows } from "../../../app/shell/roomKeyRows";
import { Dialog } from "../../../components";
import styles from "./ShortcutSheet.module.css";
import { SHORTCUTS, type Shortcut } from "./shortcuts";

const GROUPS = ["Tools", "Parts", "Change", "Shapes", "View"] as const;
const OF_A_VIEW: readonly KeyRow[] = [
  ["Arrows", "Turn the shape"],
  ["Shift+arrows", "Move it"],
  ["+ −", "Nearer, farther"],
  ["Right button", "Turn, tool in hand"],
  ["Two fingers", "Move and zoom"],
];

/** Every key of the workbench, from the table that also runs them. */
export function ShortcutSheet({ onClose }: { onClose: () => void }) {
  const me = useMe();
  return (
    <Dialog title="Keys of the workbench" size="wide" onClose={onClose}>
      <div className={styles.groups}>
        {GROUPS.map((group) => (
          <KeyGroup key={group} heading={group} rows={rowsOf(group)} />
        ))}
        <KeyGroup heading="In a view" rows={OF_A_VIEW} />
        <KeyGroup heading="Rooms" rows={roomKeyRows(me)} />
      </div>
    </Dialog>
  );
}

function rowsOf(group: Shortcut["group"]): readonly KeyRow[] {
  return SHORTCUTS.filter((shortcut) => shortcut.group === group).map(({ shown, what }) => [shown, what]);
}
