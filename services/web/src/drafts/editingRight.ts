/**
 * One tab edits a draft, the others watch: a lock that tabs share, and a channel on which they talk.
 *
 * Where a browser has no locks (they need a secure context), every tab may edit; the service then refuses what does not
 * follow on its log, and nothing is lost either.
 */

import type { StrokeJson } from "../labels/strokes";
import type { Clock } from "./clock";
import { Observable } from "./observable";

export type TabRole = "asking" | "editing" | "watching";

export type TabMessage =
  | { readonly kind: "stroke"; readonly stroke: StrokeJson }
  /** The log is another now: whoever watches reads it anew. */
  | { readonly kind: "replaced" }
  | { readonly kind: "hand-over" }
  | { readonly kind: "confirmed" };

export interface TabChannel {
  postMessage(message: TabMessage): void;
  onmessage: ((event: MessageEvent<TabMessage>) => void) | null;
  close(): void;
}

export interface Tabs {
  readonly locks: Pick<LockManager, "request"> | null;
  channel(name: string): TabChannel;
}

const PATIENCE_MS = 1_500;

/** The lock that goes with the right to edit a draft. */
export function lockOf(draftKey: string): string {
  return `partwise draft ${draftKey}`;
}

export class EditingRight {
  readonly role = new Observable<TabRole>("asking");
  onMessage: (message: TabMessage) => void = () => {};
  /** Called before the right passes to another tab: whatever must be kept first. */
  beforeHandOver: () => Promise<void> = () => Promise.resolve();

  private readonly channel: TabChannel;
  private readonly name: string;
  private release: (() => void) | null = null;
  private waiting: AbortController | null = null;
  private isClosed = false;

  constructor(
    private readonly tabs: Tabs,
    private readonly clock: Clock,
    draftKey: string,
  ) {
    this.name = lockOf(draftKey);
    this.channel = tabs.channel(this.name);
    this.channel.onmessage = ({ data }) => void this.receive(data);
  }

  /** Edits if no other tab does; else watches, and edits once the other has gone. */
  async ask(): Promise<void> {
    if (this.tabs.locks === null) {
      this.role.set("editing");
      return;
    }
    await this.request({ ifAvailable: true });
    if (this.role.get() !== "editing") this.watch();
  }

  /** Edits, and has the tab that did so watch. */
  async takeOver(): Promise<void> {
    if (this.tabs.locks === null || this.role.get() === "editing") return;
    this.channel.postMessage({ kind: "hand-over" });
    if (!(await this.becomesEditor())) {
      this.waiting?.abort();
      await this.request({ steal: true }); // that tab is frozen, or busy for too long
    }
  }

  tell(message: TabMessage): void {
    if (!this.isClosed) this.channel.postMessage(message);
  }

  close(): void {
    this.isClosed = true;
    this.waiting?.abort();
    this.release?.();
    this.channel.close();
  }

  private watch(): void {
    if (this.isClosed) return;
    this.role.set("watching");
    this.waiting = new AbortController();
    void this.request({ signal: this.waiting.signal });
  }

  /** Ends once it is known whether the lock was had; the lock itself is held until released or stolen. */
  private request(options: LockOptions): Promise<void> {
    return new Promise((known) => {
      let isHeld = false;
      const ended = this.tabs.locks?.request(this.name, options, (lock) => {
        known();
        if (lock === null || this.isClosed) return undefined;
        isHeld = true;
        this.role.set("editing");
        return new Promise<void>((release) => {
          this.release = release;
        });
      });
      ended?.then(known, () => {
        known();
        if (isHeld && this.role.get() === "editing") this.lose(); // stolen; else called off while waiting
      });
    });
  }

  private lose(): void {
    this.release = null;
    this.watch();
  }

  private async receive(message: TabMessage): Promise<void> {
    if (message.kind !== "hand-over") return this.onMessage(message);
    if (this.release === null || this.role.get() !== "editing") return;
    const release = this.release;
    this.role.set("watching");
    await this.beforeHandOver();
    if (this.release === release) this.release = null;
    release();
    this.watch();
  }

  private becomesEditor(): Promise<boolean> {
    return new Promise((resolve) => {
      const end = (isEditor: boolean) => {
        stop();
        cancel();
        resolve(isEditor);
      };
      const stop = this.role.subscribe(() => this.role.get() === "editing" && end(true));
      const cancel = this.clock.after(PATIENCE_MS, () => end(false));
    });
  }
}

export const browserTabs: Tabs = {
  locks: typeof navigator !== "undefined" && "locks" in navigator ? navigator.locks : null,
  channel: (name) => new BroadcastChannel(name) as unknown as TabChannel,
};
