/** Strokes that an earlier visit could not send, of drafts that are not open now. */
import { type DraftIdentity, draftIdentity } from "./outbox";
import { type SenderParts, StrokeSender } from "./strokeSender";

/**
 * Sends what the outbox keeps of this person's drafts, but for the open ones. What no longer fits is set aside. What
 * cannot be sent for now stays.
 *
 * openKeys : drafts that are open, whose own senders do it.
 */
export async function sendLeftovers(
  parts: SenderParts,
  personId: number,
  openKeys: ReadonlySet<string>,
): Promise<void> {
  for (const draft of await parts.outbox.drafts().catch(() => [])) {
    if (draft.personId === personId && !openKeys.has(draft.key)) await sendLeftoversOf(parts, draft);
  }
}

async function sendLeftoversOf(parts: SenderParts, draft: DraftIdentity): Promise<void> {
  const { signal } = new AbortController();
  try {
    const found = await parts.transport.draft(draft.draftId, signal);
    if (draftIdentity(found).key !== draft.key) return; // another workspace's, served here before: it may be again
    const sender = new StrokeSender(parts, draft);
    await sender.adopt(() => parts.transport.strokes(draft.draftId, -1, signal));
    await sender.flush();
    const { kind } = sender.state.get();
    if (kind === "conflict") await sender.takeTheirs();
    else if (kind === "closed" || kind === "refused") await sender.withdraw();
    await sender.pause();
  } catch {
    // the draft cannot be read now: its strokes stay where they are, for the next visit
  }
}
