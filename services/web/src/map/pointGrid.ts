/** Finds points by place without looking at all of them: cells of equal size, each with its points. */
import { type Box, boxOf } from "./camera";
import type { MapPoints } from "./mapPoints";

const POINTS_PER_CELL = 8;
const MOST_CELLS = 512;

export class PointGrid {
  private readonly box: Box;
  private readonly side: number;
  private readonly cellX: number;
  private readonly cellY: number;
  /** Points of cell c are members[starts[c]] … members[starts[c + 1] - 1]. */
  private readonly starts: Uint32Array;
  private readonly members: Uint32Array;

  constructor(private readonly points: MapPoints) {
    this.box = boxOf(points);
    this.side = Math.max(1, Math.min(MOST_CELLS, Math.ceil(Math.sqrt(points.n / POINTS_PER_CELL))));
    this.cellX = Math.max((this.box.right - this.box.left) / this.side, 1e-12);
    this.cellY = Math.max((this.box.top - this.box.bottom) / this.side, 1e-12);
    this.starts = new Uint32Array(this.side * this.side + 1);
    this.members = new Uint32Array(points.n);
    this.fill();
  }

  /** The point nearest to a place, within a radius; -1 if there is none. */
  nearest(x: number, y: number, radius: number): number {
    let best = -1;
    let least = radius * radius;
    this.visit({ left: x - radius, right: x + radius, bottom: y - radius, top: y + radius }, (i) => {
      const distance = ((this.points.x[i] as number) - x) ** 2 + ((this.points.y[i] as number) - y) ** 2;
      if (distance > least) return;
      least = distance;
      best = i;
    });
    return best;
  }

  /** The points of a box, in ascending order. */
  within(box: Box): number[] {
    const found: number[] = [];
    this.visit(box, (i) => {
      const [x, y] = [this.points.x[i] as number, this.points.y[i] as number];
      if (x >= box.left && x <= box.right && y >= box.bottom && y <= box.top) found.push(i);
    });
    return found.sort((a, b) => a - b);
  }

  /** Calls for every point of the cells that a box touches, so for some outside it, too. */
  visit(box: Box, call: (place: number) => void): void {
    const [left, right] = [this.column(box.left), this.column(box.right)];
    const [bottom, top] = [this.rowOf(box.bottom), this.rowOf(box.top)];
    for (let row = bottom; row <= top; row++) {
      const from = this.starts[row * this.side + left] as number;
      const to = this.starts[row * this.side + right + 1] as number;
      for (let i = from; i < to; i++) call(this.members[i] as number);
    }
  }

  private fill(): void {
    const { n, x, y } = this.points;
    const cells = new Uint32Array(n);
    for (let i = 0; i < n; i++) {
      const cell = this.rowOf(y[i] as number) * this.side + this.column(x[i] as number);
      cells[i] = cell;
      (this.starts[cell + 1] as number)++;
    }
    for (let cell = 0; cell < this.side * this.side; cell++) {
      (this.starts[cell + 1] as number) += this.starts[cell] as number;
    }
    const next = this.starts.slice();
    for (let i = 0; i < n; i++) this.members[(next[cells[i] as number] as number)++] = i;
  }

  private column(x: number): number {
    return Math.min(this.side - 1, Math.max(0, Math.floor((x - this.box.left) / this.cellX)));
  }

  private rowOf(y: number): number {
    return Math.min(this.side - 1, Math.max(0, Math.floor((y - this.box.bottom) / this.cellY)));
  }
}
