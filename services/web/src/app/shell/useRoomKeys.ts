import { useEffect } from "react";
import { useLocation } from "wouter";
import { roomAddress } from "../roomAddress";
import { ROOMS } from "../rooms";
import { useMe } from "../session/MeContext";
import { hasRole } from "../session/session";
import { hasOverlay } from "./hasOverlay";
import { isTyping } from "./isTyping";

const LEADER = "g";
const PAUSE_MS = 1_200;

/** G, then the first letter of a room, goes there. here : the room one is in, which that leaves as it is. */
export function useRoomKeys(collectionId: number | null, here: string | null): void {
  const me = useMe();
  const [, navigate] = useLocation();
  useEffect(() => {
    if (collectionId === null) return undefined;
    let ledAt = Number.NEGATIVE_INFINITY;
    const onKeyDown = (event: KeyboardEvent) => {
      const key = letterOf(event);
      const isLed = event.timeStamp - ledAt < PAUSE_MS;
      ledAt = key === LEADER ? event.timeStamp : Number.NEGATIVE_INFINITY;
      if (!isLed || key === null) return;
      const room = ROOMS.find(({ path, role }) => path.startsWith(key) && hasRole(me, role));
      if (!room) return;
      event.stopImmediatePropagation(); // the letter is not one of the room's own keys
      event.preventDefault();
      if (room.path !== here) navigate(roomAddress(collectionId, room.path));
    };
    window.addEventListener("keydown", onKeyDown, { capture: true });
    return () => window.removeEventListener("keydown", onKeyDown, { capture: true });
  }, [collectionId, here, me, navigate]);
}

/** What is pressed by itself; null where it is text, or meant for a dialog or a menu. */
function letterOf(event: KeyboardEvent): string | null {
  const isPlain = !event.ctrlKey && !event.metaKey && !event.altKey && !event.shiftKey;
  return isPlain && !isTyping(event.target) && !hasOverlay() ? event.key.toLowerCase() : null;
}
