/** What stands in for the service, the clock and other tabs in tests of this folder. */
import { Problem, Unreachable } from "../api/problem";
import type { StrokeJson } from "../labels/strokes";
import type { Clock } from "./clock";
import type { TabChannel, TabMessage, Tabs } from "./editingRight";
import type { DraftRecord, DraftTransport } from "./transport";

/** A clock that stands still until told. */
export class HandClock implements Clock {
  private time = 0;
  private tasks: { at: number; task: () => void }[] = [];

  now(): number {
    return this.time;
  }

  random(): number {
    return 0.5;
  }

  after(delayMs: number, task: () => void): () => void {
    const entry = { at: this.time + delayMs, task };
    this.tasks.push(entry);
    return () => {
      this.tasks = this.tasks.filter((each) => each !== entry);
    };
  }

  /** Lets time pass, with everything that falls due and comes of it. */
  async advance(ms: number): Promise<void> {
    const until = this.time + ms;
    for (;;) {
      const due = this.tasks.filter((each) => each.at <= until).sort((a, b) => a.at - b.at)[0];
      if (due === undefined) break;
      this.time = Math.max(this.time, due.at);
      this.tasks = this.tasks.filter((each) => each !== due);
      due.task();
      await settled();
    }
    this.time = until;
    await settled();
  }
}

/** Waits until nothing is under way but what waits for the clock. IndexedDB's stand-in works on immediates. */
export async function settled(): Promise<void> {
  for (let turn = 0; turn < 60; turn++) await new Promise((resolve) => setImmediate(resolve));
}

export type Fault =
  /** The request does not arrive. */
  | "cut"
  /** It is committed, and the answer does not arrive. */
  | "lost"
  | "busy"
  | "signed-out"
  /** No answer, until the client gives up. */
  | "hangs";

/** Drafts as the service keeps them: `partwise.store.sql.drafts.append_strokes`, in short. */
export class FakeService implements DraftTransport {
  log: StrokeJson[] = [];
  outcome: string | null = null;
  head: number | null = null;
  seen: number | null = null;
  confirmedAs: string | null = null;
  nRequests = 0;
  /** What becomes of the next requests. */
  faults: Fault[] = [];

  constructor(readonly createdAt = "2026-01-01T00:00:00Z") {}

  get record(): DraftRecord {
    return {
      id: 7,
      collection_id: 1,
      shape_id: 3,
      person_id: 2,
      mesh_hash: "abc",
      base_revision: null,
      base_sha256: "",
      schema_version: 1,
      n_strokes: this.log.length,
      created_at: this.createdAt,
      outcome: this.outcome,
    };
  }

  append(_id: number, expected: number, strokes: readonly StrokeJson[], signal: AbortSignal) {
    return this.answer(signal, () => {
      const fresh = strokes.filter((stroke) => !this.log.some((known) => known.id === stroke.id));
      if (this.outcome !== null && fresh.length > 0) throw this.stale();
      const first = fresh[0]?.sequence ?? expected;
      if ((fresh.length > 0 && first !== this.log.length) || first > this.log.length) throw this.stale();
      this.log.push(...fresh);
      return this.record;
    });
  }

  draft(_id: number, signal: AbortSignal) {
    return this.answer(signal, () => this.record);
  }

  strokes(_id: number, after: number, signal: AbortSignal) {
    return this.answer(signal, () => this.log.slice(after + 1));
  }

  async confirm(_id: number, nStrokes: number, labelsSha256: string | null): Promise<void> {
    await this.answer(new AbortController().signal, () => {
      if (this.confirmedAs !== null && this.confirmedAs === labelsSha256) return;
      if (this.outcome !== null) throw conflict(`draft is ${this.outcome}`);
      const isElse = nStrokes !== this.log.length;
      if (isElse) throw conflict("labels must be as the annotator saw them"); // replaying comes before counting
      if (this.head !== this.seen) throw this.stale();
      this.outcome = "confirmed";
      this.confirmedAs = labelsSha256;
    });
  }

  async acknowledge(_id: number, revisionId: number): Promise<void> {
    this.seen = revisionId;
  }

  private async answer<T>(signal: AbortSignal, commit: () => T): Promise<T> {
    this.nRequests++;
    const fault = this.faults.shift();
    if (fault === "cut") throw new Unreachable("cut");
    if (fault === "busy") throw problem(503, "unavailable", "busy");
    if (fault === "signed-out") throw problem(401, "unauthenticated", "log in");
    if (fault === "hangs") {
      await new Promise((resolve) => signal.addEventListener("abort", resolve));
      throw new Unreachable("given up");
    }
    const result = commit();
    if (fault === "lost") throw new Unreachable("lost");
    return result;
  }

  private stale(): Problem {
    const state = {
      n_strokes: this.log.length,
      base_revision: null,
      seen_revision: this.seen,
      head_revision: this.head,
      outcome: this.outcome,
    };
    return conflict("the draft went on elsewhere", { state, recorded: [], refused: [] });
  }
}

export function conflict(detail: string, extensions: Record<string, unknown> = {}): Problem {
  return problem(409, "conflict", detail, extensions);
}

export function problem(status: number, kind: string, detail: string, extensions = {}): Problem {
  return new Problem({ type: `urn:partwise:problem:${kind}`, title: kind, status, detail, ...extensions });
}

/** A stroke at a place of the log. */
export function stroke(sequence: number, id = `stroke ${sequence}`, label = 1): StrokeJson {
  const at = "2026-01-01T00:00:00Z";
  const place = { sequence, base_revision: null, author_id: 2 };
  return { v: 1, kind: "assign", runs: [[sequence, 1]], label, id, at, ...place };
}

/** Locks and channels that some tabs of one browser share. */
export function fakeBrowser(): Tabs {
  const channels = new Map<string, Set<TabChannel>>();
  return { locks: new FakeLocks() as unknown as Pick<LockManager, "request">, channel };

  function channel(name: string): TabChannel {
    const peers = channels.get(name) ?? new Set();
    channels.set(name, peers);
    const own: TabChannel = {
      onmessage: null,
      postMessage(message: TabMessage) {
        const data = structuredClone(message);
        for (const peer of peers) {
          if (peer !== own) queueMicrotask(() => peer.onmessage?.({ data } as MessageEvent<TabMessage>));
        }
      },
      close: () => void peers.delete(own),
    };
    peers.add(own);
    return own;
  }
}

interface Waiting {
  readonly grant: () => void;
}

/** Web Locks for one exclusive lock at a time of each name: what tests need of the specification. */
class FakeLocks {
  private readonly holders = new Map<string, { readonly steal: (reason: unknown) => void }>();
  private readonly queues = new Map<string, Waiting[]>();

  request(name: string, options: LockOptions, callback: (lock: object | null) => unknown): Promise<unknown> {
    return new Promise((resolve, reject) => {
      const grant = () => {
        const holder = { steal: reject };
        this.holders.set(name, holder);
        void Promise.resolve(callback({ name })).then((value) => {
          resolve(value);
          if (this.holders.get(name) === holder) this.release(name);
        });
      };
      if (options.steal) {
        this.holders.get(name)?.steal(new DOMException("stolen", "AbortError"));
        grant();
      } else if (!this.holders.has(name)) grant();
      else if (options.ifAvailable) void Promise.resolve(callback(null)).then(resolve);
      else this.wait(name, { grant }, options.signal, reject);
    });
  }

  private wait(
    name: string,
    waiting: Waiting,
    signal: AbortSignal | undefined,
    reject: (why: unknown) => void,
  ) {
    const queue = this.queues.get(name) ?? [];
    this.queues.set(name, [...queue, waiting]);
    signal?.addEventListener("abort", () => {
      this.queues.set(
        name,
        (this.queues.get(name) ?? []).filter((each) => each !== waiting),
      );
      reject(new DOMException("called off", "AbortError"));
    });
  }

  private release(name: string): void {
    this.holders.delete(name);
    const [next, ...rest] = this.queues.get(name) ?? [];
    this.queues.set(name, rest);
    next?.grant();
  }
}
