import { Dialog } from "../../components";
import { useMe } from "../session/MeContext";
import { KeyGroup, type KeyRow } from "./KeyGroup";
import { roomKeyRows } from "./roomKeyRows";

const TABLE: readonly KeyRow[] = [
  ["Arrows", "To the next shape"],
  ["PageUp PageDown", "By what is in view"],
  ["Home End", "To the ends of a row"],
  ["Ctrl+Home Ctrl+End", "To the first, the last"],
  ["Shift+arrows", "Select on the way"],
  ["Space", "Select, or no longer"],
  ["Ctrl+A", "Select all"],
  ["Escape", "Select none"],
  ["Enter", "Open what is selected"],
  ["/", "Search names"],
];
const MAP: readonly KeyRow[] = [
  ["Arrows", "Move the map"],
  ["+ −", "Nearer, farther"],
  ["0", "The whole map"],
];

/** Keys of every room, and of the table. The workbench has a sheet of its own behind "?". */
export function ShortcutSheet({ room, onClose }: { room: string | null; onClose: () => void }) {
  const me = useMe();
  return (
    <Dialog title="Keyboard shortcuts" size="small" onClose={onClose}>
      {room === "table" && (
        <>
          <KeyGroup heading="Among shapes" rows={TABLE} />
          <KeyGroup heading="On the map" rows={MAP} />
        </>
      )}
      <KeyGroup heading="Rooms" rows={roomKeyRows(me)} />
      <KeyGroup heading="Anywhere" rows={[["?", "The keys of where you are"]]} />
    </Dialog>
  );
}
