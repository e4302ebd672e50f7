/** Moves a view's camera by the keys, while the view has the focus. */
import type { GesturedView } from "./gesturedView";

const TURN = Math.PI / 24;
const STEP = 0.06;
const NEARER = 0.85;

/** Arrows turn, with Shift they move; + and − zoom; Home frames. */
const ACTIONS: Readonly<Record<string, (view: GesturedView, isShift: boolean) => void>> = {
  ArrowLeft: (view, isShift) => (isShift ? view.move(-STEP, 0) : view.turn(-TURN, 0)),
  ArrowRight: (view, isShift) => (isShift ? view.move(STEP, 0) : view.turn(TURN, 0)),
  ArrowUp: (view, isShift) => (isShift ? view.move(0, STEP) : view.turn(0, -TURN)),
  ArrowDown: (view, isShift) => (isShift ? view.move(0, -STEP) : view.turn(0, TURN)),
  "+": (view) => view.zoom(NEARER),
  "=": (view) => view.zoom(NEARER),
  "-": (view) => view.zoom(1 / NEARER),
  Home: (view) => view.frame(),
};

export class NavigationKeys {
  readonly #view: GesturedView;

  constructor(view: GesturedView) {
    this.#view = view;
    view.element.addEventListener("keydown", this.#pressed);
  }

  remove(): void {
    this.#view.element.removeEventListener("keydown", this.#pressed);
  }

  readonly #pressed = (event: KeyboardEvent) => {
    const action = ACTIONS[event.key];
    const isElsewhere = event.target !== this.#view.element || event.ctrlKey || event.metaKey || event.altKey;
    const isDigit = event.code.startsWith("Digit"); // "+" is Shift+1 on some keyboards, "-" is 6 on others
    if (action === undefined || isElsewhere || isDigit) return;
    event.preventDefault();
    action(this.#view, event.shiftKey);
  };
}
