/**
 * One draft in one tab: its strokes on their way, its lease, and whether this tab edits or watches.
 *
 * Labels are not its affair: whoever shows them makes them from `strokes`, anew on `replaced`, one more on `followed`.
 */
import type { StrokeJson } from "../labels/strokes";
import { type ConfirmOutcome, confirmDraft } from "./confirming";
import { EditingRight, type TabMessage, type Tabs } from "./editingRight";
import type { LeaseKeeper, LeaseRecord, LeaseState } from "./leaseKeeper";
import { Observable } from "./observable";
import { draftIdentity } from "./outbox";
import { type SenderParts, StrokeSender } from "./strokeSender";
import type { DraftRecord } from "./transport";

export interface SessionParts extends SenderParts {
  readonly tabs: Tabs;
  /** Opens the draft of a lease, where it was left. */
  readonly openDraft: (leaseId: number, baseRevision: number | null) => Promise<DraftRecord>;
}

export interface SessionListener {
  /** Another log: labels must be made anew from `strokes`. */
  onReplaced(): void;
  /** One more stroke, made in another tab. */
  onFollowed(stroke: StrokeJson): void;
}

export class DraftSession<L extends LeaseRecord = LeaseRecord> {
  readonly sender: StrokeSender;
  readonly right: EditingRight;
  /** Another tab, or another computer, confirmed this draft. */
  readonly isConfirmedElsewhere = new Observable(false);
  listener: SessionListener | null = null;
  private readonly stopHearing: () => void;

  private constructor(
    private readonly parts: SessionParts,
    readonly draft: DraftRecord,
    readonly keeper: LeaseKeeper<L>,
  ) {
    const identity = draftIdentity(draft);
    this.sender = new StrokeSender(parts, identity);
    this.right = new EditingRight(parts.tabs, parts.clock, identity.key);
    this.sender.onReplaced = () => {
      this.right.tell({ kind: "replaced" });
      this.listener?.onReplaced();
    };
    this.right.onMessage = (message) => this.receive(message);
    this.right.beforeHandOver = () => this.sender.pause();
    keeper.onReclaimed = (lease) => void this.reopen(lease.id);
    this.stopHearing = keeper.state.subscribe(() => this.leaseChanged(keeper.state.get()));
  }

  /** The draft of the keeper's lease with all its strokes. It edits, or watches where another tab edits. */
  static async open<L extends LeaseRecord>(
    parts: SessionParts,
    keeper: LeaseKeeper<L>,
    baseRevision: number | null,
  ): Promise<DraftSession<L>> {
    const draft = await parts.openDraft(keeper.lease.id, baseRevision);
    const session = new DraftSession(parts, draft, keeper);
    try {
      await session.takeUp();
      await session.right.ask();
    } catch (error) {
      await session.close(); // else it would keep the right to edit from whoever tries again
      throw error;
    }
    session.right.role.subscribe(() => void session.roleChanged());
    if (session.canEdit) session.sender.resume();
    return session;
  }

  get strokes(): readonly StrokeJson[] {
    return this.sender.strokes;
  }

  get canEdit(): boolean {
    return this.right.role.get() === "editing";
  }

  /** Where the next stroke goes. */
  get place(): { sequence: number; base_revision: number | null; author_id: number } {
    const { base_revision, person_id } = this.draft;
    return { sequence: this.strokes.length, base_revision, author_id: person_id };
  }

  /** Records a stroke that was done here. */
  append(stroke: StrokeJson): void {
    if (!this.canEdit) throw new Error("another tab edits this shape; take over there first");
    this.sender.append(stroke);
    this.right.tell({ kind: "stroke", stroke });
  }

  async confirm(labelsSha256: string): Promise<ConfirmOutcome> {
    const outcome = await confirmDraft(this.parts.transport, this.sender, labelsSha256);
    if (outcome.kind === "confirmed") this.right.tell({ kind: "confirmed" });
    return outcome;
  }

  /** The person has seen labels that somebody else confirmed meanwhile. */
  acknowledge(revisionId: number): Promise<void> {
    return this.parts.transport.acknowledge(this.draft.id, revisionId);
  }

  /** Something may work again: the network, the log in, the computer after sleep. */
  wake(): void {
    if (this.canEdit) this.sender.wake();
    void this.keeper.renew();
  }

  /** Leaves the draft as it is, and the lease. Its strokes are on record or in the outbox. */
  async close(): Promise<void> {
    this.listener = null;
    this.stopHearing();
    this.keeper.onReclaimed = () => {};
    await this.sender.pause();
    this.right.close();
  }

  /** Goes on with the draft under a new lease. Another one has taken its place if it was confirmed elsewhere meanwhile. */
  private async reopen(leaseId: number): Promise<void> {
    const now = await this.parts.openDraft(leaseId, this.draft.base_revision).catch(() => this.draft);
    if (now.id !== this.draft.id) this.isConfirmedElsewhere.set(true);
  }

  private leaseChanged(lease: LeaseState): void {
    if (lease.kind === "ended" && lease.how === "confirmed") this.isConfirmedElsewhere.set(true);
  }

  private async takeUp(): Promise<void> {
    const { signal } = new AbortController();
    await this.sender.adopt(() => this.parts.transport.strokes(this.draft.id, -1, signal));
  }

  private async roleChanged(): Promise<void> {
    if (!this.canEdit) {
      await this.sender.pause();
      return;
    }
    // the tab that edited may have kept strokes that never came through the channel, and told of some that it could not keep
    const recorded = async () => this.sender.strokes.slice(0, this.sender.nOnRecord);
    await this.sender.adopt(recorded, { keepsHeard: true });
    this.listener?.onReplaced();
    this.sender.resume();
    await this.sender.refresh();
  }

  private receive(message: TabMessage): void {
    if (message.kind === "confirmed") this.isConfirmedElsewhere.set(true);
    else if (message.kind === "stroke" && this.sender.follow(message.stroke)) {
      this.listener?.onFollowed(message.stroke);
    } else if (!this.canEdit) {
      const told = this.takeUp().then(() => this.listener?.onReplaced());
      told.catch(() => {}); // the record cannot be read now: the next message tries again
    }
  }
}
