/** What the table shows, as its address says it: which labels, in what order, which shapes, and which panel is open. */

export const SHOWN = ["best", "predicted", "refined", "confirmed"] as const;
export type Shown = (typeof SHOWN)[number];

export const STATES = ["new", "failed", "ready", "review", "confirmed"] as const;
export type ShapeState = (typeof STATES)[number];

export const TILE_SIZES = ["s", "m", "l"] as const;
export type TileSize = (typeof TILE_SIZES)[number];

export const PANELS = ["map", "parts", "reviews"] as const;
export type Panel = (typeof PANELS)[number];

/** What the service takes. */
export const MAX_NAME = 200;

/** What a shape must meet, all of it; null asks for nothing. `failed` is the stage that failed, or "any". */
export interface ShapeFilters {
  /** A part of the shape's name. */
  readonly name: string | null;
  readonly state: ShapeState | null;
  readonly part: number | null;
  readonly cluster: number | null;
  readonly author: number | null;
  readonly failed: string | null;
}

export interface TableView {
  readonly shown: Shown;
  /** A score's name or "name"; null is the order in which shapes came in. */
  readonly order: string | null;
  readonly descending: boolean;
  readonly filters: ShapeFilters;
  readonly size: TileSize;
  readonly panel: Panel | null;
}

export const NO_FILTERS: ShapeFilters = {
  name: null,
  state: null,
  part: null,
  cluster: null,
  author: null,
  failed: null,
};

export const DEFAULT_VIEW: TableView = {
  shown: "best",
  order: null,
  descending: false,
  filters: NO_FILTERS,
  size: "m",
  panel: null,
};

/** The view that an address's search part asks for. What it cannot mean is left at its default. */
export function viewOf(search: string): TableView {
  const given = new URLSearchParams(search);
  const order = given.get("order");
  return {
    shown: oneOf(SHOWN, given.get("show")) ?? DEFAULT_VIEW.shown,
    order: isName(order) ? order : null,
    descending: given.get("dir") === "desc",
    filters: {
      name: searchedName(given.get("name") ?? ""),
      state: oneOf(STATES, given.get("state")),
      part: idOf(given.get("part")),
      cluster: idOf(given.get("cluster")),
      author: idOf(given.get("author")),
      failed: isName(given.get("failed")) ? given.get("failed") : null,
    },
    size: oneOf(TILE_SIZES, given.get("size")) ?? DEFAULT_VIEW.size,
    panel: oneOf(PANELS, given.get("panel")),
  };
}

/** The search part that `viewOf` reads the view from; defaults are left out, so that addresses stay short. */
export function searchOf(view: TableView): string {
  const { filters } = view;
  const said: [string, string | number | null][] = [
    ["show", view.shown === DEFAULT_VIEW.shown ? null : view.shown],
    ["order", view.order],
    ["dir", view.descending ? "desc" : null],
    ["name", filters.name],
    ["state", filters.state],
    ["part", filters.part],
    ["cluster", filters.cluster],
    ["author", filters.author],
    ["failed", filters.failed],
    ["size", view.size === DEFAULT_VIEW.size ? null : view.size],
    ["panel", view.panel],
  ];
  const search = new URLSearchParams();
  for (const [name, value] of said) if (value !== null) search.set(name, String(value));
  return search.toString();
}

/** How many filters are set. */
export function countFilters(filters: ShapeFilters): number {
  return Object.values(filters).filter((value) => value !== null).length;
}

/** The part of a name that a text asks for; null if it asks for none. */
export function searchedName(text: string): string | null {
  return text.replaceAll("\0", "").trim().slice(0, MAX_NAME) || null;
}

function oneOf<T extends string>(known: readonly T[], value: string | null): T | null {
  return known.find((each) => each === value) ?? null;
}

function idOf(value: string | null): number | null {
  return value !== null && /^\d{1,15}$/.test(value) ? Number(value) : null;
}

function isName(value: string | null): value is string {
  return value !== null && /^[a-z_]{1,64}$/.test(value);
}
