/** The rooms, and who may enter. */
import { ChartNoAxesCombined, LayoutGrid, type LucideIcon, PenTool, SlidersHorizontal } from "lucide-react";
import { type ComponentType, lazy } from "react";
import type { RoomProps } from "./roomAddress";
import { ROOM_CODE } from "./roomCode";
import type { Role } from "./session/session";

export interface Room {
  /** Its place in addresses: /c/3/table. */
  path: string;
  name: string;
  icon: LucideIcon;
  role: Role;
  /** What it is for, to those who may not enter. */
  purpose: string;
  View: ComponentType<RoomProps>;
}

export const ROOMS: readonly [Room, ...Room[]] = [
  {
    path: "table",
    name: "Table",
    icon: LayoutGrid,
    role: "annotator",
    purpose: "shows every shape of a collection",
    View: lazy(ROOM_CODE.table),
  },
  {
    path: "work",
    name: "Workbench",
    icon: PenTool,
    role: "annotator",
    purpose: "is where shapes are labelled",
    View: lazy(ROOM_CODE.work),
  },
  {
    path: "operations",
    name: "Operations",
    icon: ChartNoAxesCombined,
    role: "operator",
    purpose: "shows how the machine and the people are doing, and what has failed",
    View: lazy(ROOM_CODE.operations),
  },
  {
    path: "settings",
    name: "Settings",
    icon: SlidersHorizontal,
    role: "operator",
    purpose: "is where collections are set up, people get access, and files come in and go out",
    View: lazy(ROOM_CODE.settings),
  },
];
