/** What a view shows of its shape: the draft, which is drawn on, or something to look at beside it. */
import type { Segmentation } from "../shape/shapeRequests";

export type Shown = "draft" | Segmentation | "uncertainty";

export interface ShownChoice {
  readonly shown: Shown;
  /** On the view's own button. */
  readonly name: string;
  /** In the menu. */
  readonly words: string;
}

export const SHOWN_CHOICES: readonly [ShownChoice, ...ShownChoice[]] = [
  { shown: "draft", name: "Draft", words: "Draft" },
  { shown: "predicted", name: "Predicted", words: "Predicted labels" },
  { shown: "refined", name: "Refined", words: "Refined labels" },
  { shown: "confirmed", name: "Confirmed", words: "Confirmed labels" },
  { shown: "uncertainty", name: "Uncertainty", words: "How unsure the model is" },
];

export function choiceOf(shown: Shown): ShownChoice {
  return SHOWN_CHOICES.find((choice) => choice.shown === shown) ?? SHOWN_CHOICES[0];
}

/** The one after it in the menu, round and round. */
export function nextShown(shown: Shown): Shown {
  const at = SHOWN_CHOICES.findIndex((choice) => choice.shown === shown);
  return (SHOWN_CHOICES[(at + 1) % SHOWN_CHOICES.length] ?? SHOWN_CHOICES[0]).shown;
}

/** Why a shape has nothing of the kind to show; null if it has. */
export function whyMissing(shown: Shown, hasModel: boolean, hasConfirmed: boolean): string | null {
  if (shown === "draft") return null;
  if (shown === "confirmed") return hasConfirmed ? null : "Nobody has confirmed labels of this shape yet.";
  return hasModel ? null : "No model has seen this shape yet.";
}
