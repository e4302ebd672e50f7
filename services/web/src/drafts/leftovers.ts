/** Strokes that could not be sent while their draft was open, which it is not now. */
import { lockOf, type Tabs } from "./editingRight";
import { type DraftIdentity, draftIdentity } from "./outbox";
import { type SenderParts, StrokeSender } from "./strokeSender";

const ANSWER_MS = 30_000;

export interface LeftoverParts extends SenderParts {
  readonly tabs: Pick<Tabs, "locks">;
}

export class Leftovers {
  private isSending = false;
  /** Something may have been left since this round began. */
  private isAskedAgain = false;

  /** isAtWork : whether a draft is open here, or about to be: its own sender does it then. */
  constructor(
    private readonly parts: LeftoverParts,
    private readonly personId: number,
    private readonly isAtWork: (draft: DraftIdentity) => boolean,
  ) {}

  /**
   * Sends what the outbox keeps of this person's drafts, but for those that this tab or another has open. What can no
   * longer be taken is set aside. What cannot be sent for now stays; so does what the person has to choose about.
   */
  async send(): Promise<void> {
    this.isAskedAgain = true;
    if (this.isSending) return;
    this.isSending = true;
    try {
      while (this.isAskedAgain) await this.sendRound();
    } finally {
      this.isSending = false;
    }
  }

  private async sendRound(): Promise<void> {
    this.isAskedAgain = false;
    for (const draft of await this.parts.outbox.drafts().catch(() => [])) {
      if (draft.personId === this.personId && !this.isAtWork(draft)) await this.sendAlone(draft);
    }
  }

  private async sendAlone(draft: DraftIdentity): Promise<void> {
    const { locks } = this.parts.tabs;
    const send = () => sendLeftoversOf(this.parts, draft);
    try {
      if (locks === null) await send();
      else await locks.request(lockOf(draft.key), { ifAvailable: true }, (lock) => lock && send());
    } catch {
      // another tab took the right to edit: the draft is open there, and its own sender goes on
    }
  }
}

async function sendLeftoversOf(parts: SenderParts, draft: DraftIdentity): Promise<void> {
  const request = new AbortController();
  const giveUp = parts.clock.after(ANSWER_MS, () => request.abort());
  try {
    const found = await parts.transport.draft(draft.draftId, request.signal);
    if (draftIdentity(found).key !== draft.key) return; // another workspace's, served here before: it may be again
    const sender = new StrokeSender(parts, draftIdentity(found));
    await sender.adopt(() => parts.transport.strokes(draft.draftId, -1, request.signal));
    giveUp();
    await sender.flush();
    const { kind } = sender.state.get();
    // of two versions the person chooses once they open the draft, which can no longer be where it is closed
    if (kind === "conflict" && found.outcome !== null) await sender.takeTheirs();
    else if (kind === "closed" || kind === "refused") await sender.withdraw();
    await sender.pause();
  } catch {
    // the draft cannot be read now: its strokes stay where they are, for the next time
  } finally {
    giveUp();
  }
}
