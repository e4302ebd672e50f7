/** A part as it is being written, and what keeps it from being saved. */
import { nextColour } from "./contrast";
import type { Part, PartDraft } from "./partRequests";

const MAX_NAME = 64;

export function newDraft(parts: readonly Part[]): PartDraft {
  return { name: "", colour: nextColour(parts.map((part) => part.colour)), gloss: "", parentId: null };
}

export function draftOf(part: Part): PartDraft {
  return { name: part.name, colour: part.colour, gloss: part.gloss, parentId: part.parent_id };
}

/** What is wrong with the name; null if nothing is. */
export function nameError(draft: PartDraft, others: readonly Part[]): string | null {
  const name = draft.name.trim();
  if (name === "") return "Give the part a name.";
  if (name.length > MAX_NAME) return `A name has at most ${MAX_NAME} letters.`;
  const same = others.find((part) => part.name.toLowerCase() === name.toLowerCase());
  return same ? `There is a part ${same.name} already.` : null;
}

/** Parts that this one can be put below: neither itself nor what is below it. */
export function possibleParents(parts: readonly Part[], partId: number | null): readonly Part[] {
  const below = (part: Part): boolean => {
    if (part.id === partId) return true;
    const parent = parts.find((each) => each.id === part.parent_id);
    return parent !== undefined && below(parent);
  };
  return partId === null ? parts : parts.filter((part) => !below(part));
}

/** Parts with how deep each is below others, children after their parents, else in their order. */
export function asTree(parts: readonly Part[]): readonly { part: Part; depth: number }[] {
  const under = (parentId: number | null, depth: number): { part: Part; depth: number }[] =>
    parts
      .filter((part) => part.parent_id === parentId)
      .flatMap((part) => [{ part, depth }, ...under(part.id, depth + 1)]);
  return under(null, 0);
}
