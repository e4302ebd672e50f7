/** Which tool is in hand and how it is set: kept in this browser, the same for all shapes. */
import { Observable } from "../../../drafts/observable";

export type ToolName = "turn" | "paint" | "patches" | "segment" | "pick";
export type PatchMethod = "random_walks" | "k_means";
export type StartChoice = "best" | "refined" | "predicted" | "nothing";

export interface ToolSettings {
  readonly tool: ToolName;
  /** Part in hand; 0 takes labels away. */
  readonly part: number;
  /** Of the brush, a share of the shape's diagonal. */
  readonly radius: number;
  readonly hasAngleLimit: boolean;
  readonly angleDegrees: number;
  /** Paint only over this part (0: unlabelled); null for all. */
  readonly onlyOver: number | null;
  readonly nPatches: number;
  readonly method: PatchMethod;
  /** Weight of angles against the shape's thickness, in refining boundaries. */
  readonly omega: number;
  /** What a shape without strokes starts from. */
  readonly start: StartChoice;
}

export const RADIUS = { min: 0.004, max: 0.3, step: 1.25 } as const;
export const PATCHES = { min: 5, max: 200, step: 5 } as const;

const KEY = "partwise.tools";
const DEFAULTS: ToolSettings = {
  tool: "paint",
  part: 1,
  radius: 0.04,
  hasAngleLimit: false,
  angleDegrees: 45,
  onlyOver: null,
  nPatches: 40,
  method: "random_walks",
  omega: 0.5,
  start: "best",
};

export class ToolShelf {
  readonly settings: Observable<ToolSettings>;

  constructor(private readonly storage: Pick<Storage, "getItem" | "setItem">) {
    this.settings = new Observable(this.saved());
  }

  change(some: Partial<ToolSettings>): void {
    const next = { ...this.settings.get(), ...some };
    this.settings.set(next);
    try {
      this.storage.setItem(KEY, JSON.stringify(next));
    } catch {
      // a full or forbidden storage costs the settings after a reload, no more
    }
  }

  /** The brush larger (1) or smaller (−1). */
  scaleBrush(direction: 1 | -1): void {
    const radius = this.settings.get().radius * RADIUS.step ** direction;
    this.change({ radius: Math.min(RADIUS.max, Math.max(RADIUS.min, Number(radius.toPrecision(3)))) });
  }

  morePatches(direction: 1 | -1): void {
    const nPatches = this.settings.get().nPatches + direction * PATCHES.step;
    this.change({ nPatches: Math.min(PATCHES.max, Math.max(PATCHES.min, nPatches)) });
  }

  private saved(): ToolSettings {
    try {
      const kept: unknown = JSON.parse(this.storage.getItem(KEY) ?? "{}");
      if (typeof kept !== "object" || kept === null) return DEFAULTS;
      const known = Object.entries(DEFAULTS).map(([key, value]) => {
        const own = (kept as Record<string, unknown>)[key];
        return [key, key === "onlyOver" ? null : typeof own === typeof value ? own : value];
      });
      return Object.fromEntries(known) as ToolSettings;
    } catch {
      return DEFAULTS;
    }
  }
}
