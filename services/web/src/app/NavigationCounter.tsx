import { type ReactNode, useState } from "react";
import { useLocation } from "wouter";
import { NavigationContext } from "./RoomHeading";

const ROOM_OF_ADDRESS = /^\/c\/\d+\/[^/]+/;

/** Counts how often the room has changed, so that headings take the focus then, and not when the page is loaded. */
export function NavigationCounter({ children }: { children: ReactNode }) {
  const [location] = useLocation();
  const room = ROOM_OF_ADDRESS.exec(location)?.[0] ?? "";
  const [last, setLast] = useState({ room, n: 0 });
  if (last.room !== room) setLast({ room, n: last.room === "" ? last.n : last.n + 1 });
  return <NavigationContext value={last.n}>{children}</NavigationContext>;
}
