import type { QueryClient } from "@tanstack/react-query";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { App } from "./app/App";
import { HeadStartContext } from "./rooms/workbench/desk/HeadStartContext";
import type { HeadStart } from "./rooms/workbench/desk/headStart";

/** Shows the page. code : a one-time login that came with the address. */
export function showPage(queries: QueryClient, code: string | null, headStart: HeadStart | null): void {
  const root = document.getElementById("root");
  if (root === null) throw new Error("index.html has no element #root");
  createRoot(root).render(
    <StrictMode>
      <HeadStartContext value={headStart}>
        <App queries={queries} code={code} />
      </HeadStartContext>
    </StrictMode>,
  );
}
