import { createContext } from "react";
import type { HeadStart } from "./headStart";

/** What was asked for before the page was there; null where the workbench was not the first room to be entered. */
export const HeadStartContext = createContext<HeadStart | null>(null);
