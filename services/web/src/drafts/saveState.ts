/** How far a draft's strokes are on their way, as the person is told. */
import type { Divergence } from "./reconcile";

interface Queued {
  readonly nQueued: number;
  /** Whether all that is queued outlives this tab. */
  readonly isKept: boolean;
}

export type SaveState =
  | { readonly kind: "saved" }
  | (Queued & { readonly kind: "saving" })
  | (Queued & { readonly kind: "offline"; readonly why: string })
  | (Queued & { readonly kind: "signed-out"; readonly why: string })
  /** The draft went on elsewhere. Nothing is sent until the person chooses. */
  | (Queued & { readonly kind: "conflict"; readonly divergence: Divergence })
  /** The draft was confirmed or discarded elsewhere. */
  | (Queued & { readonly kind: "closed"; readonly why: string })
  | (Queued & { readonly kind: "refused"; readonly why: string });
