import { Check, Copy } from "lucide-react";
import { useState } from "react";
import { Button } from "./Button";

const TOLD_MS = 2_000;

/** Puts a text on the clipboard and says so. */
export function CopyButton({ text, label = "Copy" }: { text: string; label?: string }) {
  const [state, setState] = useState<"ready" | "copied" | "refused">("ready");
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
      setState("copied");
      window.setTimeout(() => setState("ready"), TOLD_MS);
    } catch {
      setState("refused"); // the browser allows it on https and localhost only
    }
  };
  const words = { ready: label, copied: "Copied", refused: "Select and copy by hand" }[state];
  return (
    <Button size="small" icon={state === "copied" ? <Check /> : <Copy />} onClick={copy} aria-live="polite">
      {words}
    </Button>
  );
}
