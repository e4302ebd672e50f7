import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { newQueryClient } from "./api/queries";
import { App } from "./app/App";
import { applyScheme, savedScheme } from "./app/scheme/scheme";
import { takeOneTimeCode } from "./app/session/oneTimeCode";
import "./styles/tokens.css";
import "./styles/base.css";

const code = takeOneTimeCode(window);
applyScheme(savedScheme(localStorage), document.documentElement);
const root = document.getElementById("root");
if (root === null) throw new Error("index.html has no element #root");
createRoot(root).render(
  <StrictMode>
    <App queries={newQueryClient()} code={code} />
  </StrictMode>,
);
