/**
 * The device's outbox, with this page's memory in reserve: for what the device has no room for, fails to keep, or does
 * not answer about.
 */
import type { StrokeJson } from "../labels/strokes";
import type { Clock } from "./clock";
import { Observable } from "./observable";
import type { DraftIdentity, KeptAside, Outbox, SetAside } from "./outbox";

/** Nothing waits longer for the device. */
export const DEVICE_PATIENCE_MS = 3_000;

interface Held {
  readonly draft: DraftIdentity;
  readonly stroke: StrokeJson;
}

export class ReserveOutbox implements Outbox {
  readonly asidesChanged = new Observable(0);
  /** By the stroke's id. */
  private readonly held = new Map<string, Held>();
  /** By ids that the device does not give. */
  private readonly heldAside = new Map<number, SetAside>();
  private readonly storingAside = new Set<number>();
  private lastId = 0;

  constructor(
    private readonly device: Outbox,
    private readonly clock: Clock,
  ) {}

  /** Whether nothing is lost if the page is closed now. */
  get isEmpty(): boolean {
    return this.held.size === 0 && this.heldAside.size === 0;
  }

  /** Rejects where the stroke is only in memory. */
  async add(draft: DraftIdentity, stroke: StrokeJson): Promise<void> {
    this.hold(draft, [stroke]);
    await this.stored(this.device.add(draft, stroke), [stroke]);
  }

  async pending(draftKey: string): Promise<StrokeJson[]> {
    const kept = await this.inTime(this.device.pending(draftKey)).catch(() => []);
    const known = new Set(kept.map((stroke) => stroke.id));
    const held = [...this.held.values()].filter(
      ({ draft, stroke }) => draft.key === draftKey && !known.has(stroke.id),
    );
    return [...kept, ...held.map(({ stroke }) => stroke)].sort((a, b) => a.sequence - b.sequence);
  }

  async remove(draftKey: string, strokes: readonly StrokeJson[]): Promise<void> {
    this.drop(strokes);
    if (strokes.length > 0) await this.inTime(this.device.remove(draftKey, strokes));
  }

  /** Rejects where those that come are only in memory. */
  async replace(
    draft: DraftIdentity,
    gone: readonly StrokeJson[],
    come: readonly StrokeJson[],
  ): Promise<void> {
    this.drop(gone);
    this.hold(draft, come);
    await this.stored(this.device.replace(draft, gone, come), come);
  }

  async setAside(aside: SetAside): Promise<void> {
    const id = --this.lastId;
    this.drop(aside.strokes);
    this.heldAside.set(id, aside);
    await this.storeAside(id, aside);
  }

  /** The device may have room again: gives it the versions that only memory has. */
  async storeAgain(): Promise<void> {
    for (const [id, aside] of [...this.heldAside]) {
      if (!this.storingAside.has(id)) await this.storeAside(id, aside);
    }
  }

  async asides(): Promise<KeptAside[]> {
    const kept = await this.inTime(this.device.asides()).catch(() => []);
    return [...kept, ...[...this.heldAside].map(([id, aside]) => ({ ...aside, id }))];
  }

  async forgetAside(id: number): Promise<void> {
    if (!this.heldAside.delete(id)) await this.inTime(this.device.forgetAside(id));
    this.tellAsides();
  }

  async drafts(): Promise<DraftIdentity[]> {
    const kept = await this.inTime(this.device.drafts()).catch(() => []);
    const all = [...kept, ...[...this.held.values()].map(({ draft }) => draft)];
    return [...new Map(all.map((draft) => [draft.key, draft])).values()];
  }

  private hold(draft: DraftIdentity, strokes: readonly StrokeJson[]): void {
    for (const stroke of strokes) this.held.set(stroke.id, { draft, stroke });
  }

  private drop(strokes: readonly StrokeJson[]): void {
    for (const { id } of strokes) this.held.delete(id);
  }

  private stored(storing: Promise<void>, strokes: readonly StrokeJson[]): Promise<void> {
    return this.inTime(storing.then(() => this.drop(strokes)));
  }

  private async storeAside(id: number, aside: SetAside): Promise<void> {
    this.storingAside.add(id);
    const kept = this.device
      .setAside(aside)
      .then(() => this.heldAside.delete(id))
      .finally(() => this.storingAside.delete(id));
    await this.inTime(kept).catch(() => {}); // it stays in memory, then
    this.tellAsides();
  }

  private tellAsides(): void {
    this.asidesChanged.set(this.asidesChanged.get() + 1);
  }

  private inTime<T>(answer: Promise<T>): Promise<T> {
    return new Promise((resolve, reject) => {
      const giveUp = this.clock.after(DEVICE_PATIENCE_MS, () =>
        reject(new Error("This browser's database does not answer. Leave this tab open.")),
      );
      void answer.then(resolve, reject).finally(giveUp);
    });
  }
}
