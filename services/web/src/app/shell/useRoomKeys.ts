import { useEffect } from "react";
import { useLocation } from "wouter";
import { roomAddress } from "../roomAddress";
import { ROOMS } from "../rooms";
import { useMe } from "../session/MeContext";
import { hasRole } from "../session/session";
import { isTyping } from "./isTyping";

const LEADER = "g";
const PAUSE_MS = 1_200;

/** G, then the first letter of a room, goes there. */
export function useRoomKeys(collectionId: number | null): void {
  const me = useMe();
  const [, navigate] = useLocation();
  useEffect(() => {
    if (collectionId === null) return undefined;
    let ledAt = Number.NEGATIVE_INFINITY;
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
      const key = event.key.toLowerCase();
      const isLed = event.timeStamp - ledAt < PAUSE_MS;
      ledAt = key === LEADER ? event.timeStamp : Number.NEGATIVE_INFINITY;
      const room = isLed && ROOMS.find(({ path, role }) => path.startsWith(key) && hasRole(me, role));
      if (!room) return;
      event.stopImmediatePropagation(); // the letter is not one of the room's own keys
      event.preventDefault();
      navigate(roomAddress(collectionId, room.path));
    };
    window.addEventListener("keydown", onKeyDown, { capture: true });
    return () => window.removeEventListener("keydown", onKeyDown, { capture: true });
  }, [collectionId, me, navigate]);
}
