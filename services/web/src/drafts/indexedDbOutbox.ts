/** The outbox in IndexedDB, which outlives the tab and the browser. */
import { type DBSchema, type IDBPDatabase, openDB } from "idb";
import type { StrokeJson } from "../labels/strokes";
import { Observable } from "./observable";
import type { DraftIdentity, KeptAside, Outbox, SetAside } from "./outbox";

interface Entry {
  readonly key: string;
  readonly id: string;
  /** Order of arrival: entries of one place stay apart. */
  readonly at: number;
  readonly draft: DraftIdentity;
  readonly stroke: StrokeJson;
}

interface Schema extends DBSchema {
  outbox: { key: [string, string]; value: Entry; indexes: { byDraft: string } };
  aside: { key: number; value: SetAside & { readonly id?: number } };
}

const VERSION = 1;

export class IndexedDbOutbox implements Outbox {
  readonly asidesChanged = new Observable(0);
  private isAsked = false;
  private database: Promise<IDBPDatabase<Schema>> | null = null;

  constructor(private readonly name = "partwise") {}

  async add(draft: DraftIdentity, stroke: StrokeJson): Promise<void> {
    if (!this.isAsked) askToPersist();
    this.isAsked = true;
    const database = await this.open();
    const transaction = database.transaction("outbox", "readwrite", { durability: "strict" });
    const entry = { key: draft.key, id: stroke.id, at: Date.now(), draft, stroke };
    await Promise.all([transaction.store.put(entry), transaction.done]);
  }

  async pending(draftKey: string): Promise<StrokeJson[]> {
    const entries = await (await this.open()).getAllFromIndex("outbox", "byDraft", draftKey);
    const inOrder = entries.sort((a, b) => a.stroke.sequence - b.stroke.sequence || a.at - b.at);
    return inOrder.map((entry) => entry.stroke);
  }

  async remove(draftKey: string, strokes: readonly StrokeJson[]): Promise<void> {
    const transaction = (await this.open()).transaction("outbox", "readwrite");
    const deletions = strokes.map((stroke) => transaction.store.delete([draftKey, stroke.id]));
    await Promise.all([...deletions, transaction.done]);
  }

  async replace(
    draft: DraftIdentity,
    gone: readonly StrokeJson[],
    come: readonly StrokeJson[],
  ): Promise<void> {
    const transaction = (await this.open()).transaction("outbox", "readwrite", { durability: "strict" });
    const at = Date.now();
    await Promise.all([
      ...gone.map((stroke) => transaction.store.delete([draft.key, stroke.id])),
      ...come.map((stroke) => transaction.store.put({ key: draft.key, id: stroke.id, at, draft, stroke })),
      transaction.done,
    ]);
  }

  async setAside(aside: SetAside): Promise<void> {
    const transaction = (await this.open()).transaction(["outbox", "aside"], "readwrite", {
      durability: "strict",
    });
    const outbox = transaction.objectStore("outbox");
    await Promise.all([
      transaction.objectStore("aside").add(aside),
      ...aside.strokes.map((stroke) => outbox.delete([aside.draft.key, stroke.id])),
      transaction.done,
    ]);
    this.asidesChanged.set(this.asidesChanged.get() + 1);
  }

  async asides(): Promise<KeptAside[]> {
    return (await (await this.open()).getAll("aside")) as KeptAside[];
  }

  async forgetAside(id: number): Promise<void> {
    await (await this.open()).delete("aside", id);
    this.asidesChanged.set(this.asidesChanged.get() + 1);
  }

  async drafts(): Promise<DraftIdentity[]> {
    const entries = await (await this.open()).getAll("outbox");
    return [...new Map(entries.map((entry) => [entry.key, entry.draft])).values()];
  }

  private open(): Promise<IDBPDatabase<Schema>> {
    this.database ??= openDB<Schema>(this.name, VERSION, {
      upgrade(database) {
        database.createObjectStore("outbox", { keyPath: ["key", "id"] }).createIndex("byDraft", "key");
        database.createObjectStore("aside", { keyPath: "id", autoIncrement: true });
      },
      terminated: () => {
        this.database = null;
      },
    }).catch((error: unknown) => {
      this.database = null;
      throw error;
    });
    return this.database;
  }
}

/** That the browser does not clear what is kept when the disk runs full. Pages that are not secure have nobody to ask. */
function askToPersist(): void {
  const storage: Partial<StorageManager> | undefined = globalThis.navigator?.storage;
  storage?.persist?.().catch(() => {});
}
