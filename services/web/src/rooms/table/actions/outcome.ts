/** What became of shapes that something was asked for, one by one. */
import { count } from "../../../components/numbers";

export interface Refusal {
  readonly shapeId: number;
  readonly why: string;
}

export interface Outcome {
  readonly done: readonly number[];
  readonly refused: readonly Refusal[];
}

/** Requests under way at a time. */
const AT_ONCE = 4;

/** Asks for each shape by itself; one that is refused does not keep the others from being done. */
export async function askForEach(
  shapeIds: readonly number[],
  ask: (shapeId: number) => Promise<unknown>,
  onProgress: (nAsked: number) => void = () => undefined,
): Promise<Outcome> {
  const done: number[] = [];
  const refused: Refusal[] = [];
  const waiting = [...shapeIds];
  const work = async () => {
    for (let shapeId = waiting.shift(); shapeId !== undefined; shapeId = waiting.shift()) {
      try {
        await ask(shapeId);
        done.push(shapeId);
      } catch (error) {
        refused.push({ shapeId, why: error instanceof Error ? error.message : String(error) });
      }
      onProgress(done.length + refused.length);
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, work));
  return { done, refused };
}

/** "12 shapes sent back" */
export function outcomeWords(n: number, done: string): string {
  return `${count(n, "shape")} ${done}`;
}

/** Refusals that say the same, together. */
export function grouped(
  refused: readonly Refusal[],
  nameOf: (shapeId: number) => string,
): [string, string[]][] {
  const groups = new Map<string, string[]>();
  for (const { shapeId, why } of refused) {
    // Refusals name the shape by its number, which is told by its name here.
    const reason = why.replaceAll(new RegExp(`\\b(of )?shape ${shapeId}\\b`, "g"), "$1this shape");
    groups.set(reason, [...(groups.get(reason) ?? []), nameOf(shapeId)]);
  }
  return [...groups];
}
