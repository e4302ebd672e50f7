/** Every key of the workbench, once: what is pressed, what it does, and what the sheet says. */

export interface WorkbenchActions {
  useTool(tool: "turn" | "paint" | "patches" | "segment" | "pick"): void;
  /** The part at a place of the list, from 0. */
  usePart(place: number): void;
  unlabel(): void;
  scaleBrush(direction: 1 | -1): void;
  morePatches(direction: 1 | -1): void;
  toggleAngleLimit(): void;
  press(): void;
  undo(): void;
  redo(): void;
  refineBoundaries(): void;
  refineWithModel(): void;
  confirm(): void;
  skip(): void;
  nextShape(): void;
  cycleViews(): void;
  toggleLink(): void;
  cycleShown(): void;
  toggleUncertainty(): void;
  toggleEdges(): void;
  frame(): void;
  look(name: "front" | "back" | "left" | "right" | "top" | "bottom"): void;
  showKeys(): void;
}

export interface Shortcut {
  /** `event.key` in lower case, with modifiers before it. */
  readonly keys: readonly string[];
  /** As it is shown. */
  readonly shown: string;
  readonly what: string;
  readonly group: "Tools" | "Parts" | "Change" | "Shapes" | "View";
  run(actions: WorkbenchActions, key: string): void;
}

const DIGITS = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "0"];

export const SHORTCUTS: readonly Shortcut[] = [
  { keys: ["b"], shown: "B", what: "Paint", group: "Tools", run: (act) => act.useTool("paint") },
  { keys: ["p"], shown: "P", what: "Patches", group: "Tools", run: (act) => act.useTool("patches") },
  { keys: ["w"], shown: "W", what: "Whole segment", group: "Tools", run: (act) => act.useTool("segment") },
  {
    keys: ["i"],
    shown: "I",
    what: "Pick the part under the pointer",
    group: "Tools",
    run: (act) => act.useTool("pick"),
  },
  { keys: ["h"], shown: "H", what: "Turn the shape", group: "Tools", run: (act) => act.useTool("turn") },
  { keys: ["["], shown: "[", what: "Smaller brush", group: "Tools", run: (act) => act.scaleBrush(-1) },
  { keys: ["]"], shown: "]", what: "Larger brush", group: "Tools", run: (act) => act.scaleBrush(1) },
  { keys: [","], shown: ",", what: "Fewer patches", group: "Tools", run: (act) => act.morePatches(-1) },
  { keys: ["."], shown: ".", what: "More patches", group: "Tools", run: (act) => act.morePatches(1) },
  {
    keys: ["a"],
    shown: "A",
    what: "Angle limit of the brush",
    group: "Tools",
    run: (act) => act.toggleAngleLimit(),
  },
  {
    keys: [" "],
    shown: "Space",
    what: "Press mid-view",
    group: "Tools",
    run: (act) => act.press(),
  },
  {
    keys: DIGITS,
    shown: "1 … 9 0",
    what: "Parts one to ten",
    group: "Parts",
    run: (act, key) => act.usePart(DIGITS.indexOf(key)),
  },
  {
    keys: DIGITS.map((digit) => `shift+${digit}`),
    shown: "Shift+1 … 0",
    what: "Parts eleven to twenty",
    group: "Parts",
    run: (act, key) => act.usePart(10 + DIGITS.indexOf(key.replace("shift+", ""))),
  },
  { keys: ["e"], shown: "E", what: "No part: take labels away", group: "Parts", run: (act) => act.unlabel() },
  { keys: ["ctrl+z"], shown: "Ctrl+Z", what: "Undo", group: "Change", run: (act) => act.undo() },
  {
    keys: ["ctrl+shift+z", "ctrl+y"],
    shown: "Ctrl+Shift+Z",
    what: "Redo",
    group: "Change",
    run: (act) => act.redo(),
  },
  {
    keys: ["r"],
    shown: "R",
    what: "Refine boundaries",
    group: "Change",
    run: (act) => act.refineBoundaries(),
  },
  {
    keys: ["m"],
    shown: "M",
    what: "Refine with the model",
    group: "Change",
    run: (act) => act.refineWithModel(),
  },
  { keys: ["enter"], shown: "Enter", what: "Confirm and next", group: "Shapes", run: (act) => act.confirm() },
  {
    keys: ["s"],
    shown: "S",
    what: "Skip the shape, with a reason",
    group: "Shapes",
    run: (act) => act.skip(),
  },
  {
    keys: ["n"],
    shown: "N",
    what: "Next of the shapes in hand",
    group: "Shapes",
    run: (act) => act.nextShape(),
  },
  { keys: ["v"], shown: "V", what: "One to four views", group: "View", run: (act) => act.cycleViews() },
  { keys: ["l"], shown: "L", what: "Link the cameras", group: "View", run: (act) => act.toggleLink() },
  {
    keys: ["d"],
    shown: "D",
    what: "Draft, predicted, refined, …",
    group: "View",
    run: (act) => act.cycleShown(),
  },
  {
    keys: ["u"],
    shown: "U",
    what: "How unsure the model is",
    group: "View",
    run: (act) => act.toggleUncertainty(),
  },
  {
    keys: ["t"],
    shown: "T",
    what: "Edges of faces",
    group: "View",
    run: (act) => act.toggleEdges(),
  },
  { keys: ["f"], shown: "F", what: "Whole shape in view", group: "View", run: (act) => act.frame() },
  {
    keys: ["shift+f"],
    shown: "Shift+F",
    what: "From the front",
    group: "View",
    run: (act) => act.look("front"),
  },
  {
    keys: ["shift+b"],
    shown: "Shift+B",
    what: "From the back",
    group: "View",
    run: (act) => act.look("back"),
  },
  {
    keys: ["shift+l"],
    shown: "Shift+L",
    what: "From the left",
    group: "View",
    run: (act) => act.look("left"),
  },
  {
    keys: ["shift+r"],
    shown: "Shift+R",
    what: "From the right",
    group: "View",
    run: (act) => act.look("right"),
  },
  { keys: ["shift+t"], shown: "Shift+T", what: "From the top", group: "View", run: (act) => act.look("top") },
  {
    keys: ["shift+u"],
    shown: "Shift+U",
    what: "From below",
    group: "View",
    run: (act) => act.look("bottom"),
  },
  { keys: ["?", "shift+?"], shown: "?", what: "This sheet", group: "View", run: (act) => act.showKeys() },
];

const BY_KEY = new Map(SHORTCUTS.flatMap((shortcut) => shortcut.keys.map((key) => [key, shortcut] as const)));
/** What many keyboards have only behind AltGr, which a Mac calls Option. */
const BEHIND_ALT: readonly string[] = ["[", "]"];
/** Keys that are also known by their place: Shift+1 is "!" on some keyboards, and "[" stands nowhere by itself on others. */
const PLACES: ReadonlyMap<string, string> = new Map([
  ...DIGITS.flatMap((digit) => [[`Digit${digit}`, digit] as const, [`Numpad${digit}`, digit] as const]),
  ["BracketLeft", "["],
  ["BracketRight", "]"],
]);

type Pressed = Pick<
  KeyboardEvent,
  "key" | "code" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey" | "getModifierState"
>;
type Found = { shortcut: Shortcut; key: string };

/** The shortcut that an event means, with the key as the table writes it. */
export function shortcutOf(event: Pressed): Found | null {
  if (event.altKey || event.getModifierState("AltGraph")) {
    return BEHIND_ALT.includes(event.key) ? found(event.key) : null; // Windows takes AltGr for Ctrl and Alt
  }
  const modifiers = `${event.ctrlKey || event.metaKey ? "ctrl+" : ""}${event.shiftKey ? "shift+" : ""}`;
  return found(modifiers + event.key.toLowerCase()) ?? found(modifiers + placed(event));
}

function found(key: string): Found | null {
  const shortcut = BY_KEY.get(key);
  return shortcut === undefined ? null : { shortcut, key };
}

function placed({ key, code }: Pressed): string {
  const isNearer = key === "+" && code === "BracketRight"; // German, and of a view
  return isNearer ? key : (PLACES.get(code) ?? key);
}

/** What is pressed for something, for tooltips. */
export function keysFor(what: string): string | undefined {
  return SHORTCUTS.find((shortcut) => shortcut.what === what)?.shown;
}
