import { type ReactNode, useState } from "react";
import type { Collection } from "../CollectionContext";
import styles from "./Shell.module.css";
import { ShortcutSheet } from "./ShortcutSheet";
import { TopBar } from "./TopBar";
import { useRoomKeys } from "./useRoomKeys";
import { useSheetKey } from "./useSheetKey";

/** Rooms with keys of their own, and a sheet that tells them. */
const HAVE_SHEETS: ReadonlySet<string> = new Set(["work"]);

export interface ShellProps {
  collection: Collection | null;
  room: string | null;
  children: ReactNode;
}

/** The bar, and a room that has all the rest of the window: rooms scroll by themselves, or let the page do it. */
export function Shell({ collection, room, children }: ShellProps) {
  useRoomKeys(collection?.id ?? null, room);
  const [isSheetOpen, setSheetOpen] = useState(false);
  useSheetKey(room === null || !HAVE_SHEETS.has(room), () => setSheetOpen(true));
  return (
    <div className={styles.shell}>
      <a href="#room" className={styles.skip}>
        Skip to the room
      </a>
      <TopBar collection={collection} room={room} />
      <main id="room" tabIndex={-1} className={styles.room}>
        {children}
      </main>
      {isSheetOpen && <ShortcutSheet room={room} onClose={() => setSheetOpen(false)} />}
    </div>
  );
}
