/** Words for what the table shows of a shape. */
import type { ShapeRow } from "../rows/shapeRows";
import type { ShapeState, Shown } from "../view/tableView";

export const STATE_WORDS: Readonly<Record<ShapeState, string>> = {
  new: "New",
  failed: "Failed",
  ready: "Ready",
  review: "In review",
  confirmed: "Confirmed",
};

export const SHOWN_WORDS: Readonly<Record<Shown, string>> = {
  best: "Best available",
  predicted: "Predicted",
  refined: "Refined",
  confirmed: "Confirmed",
};

/** What a stage does, for people; its own name where it has no better one. */
export function stageWords(stage: string): string {
  const known: Readonly<Record<string, string>> = {
    any: "any stage",
    mesh: "reading",
    remesh: "remeshing",
    describe: "describing",
    picture: "drawing",
    evaluate: "predicting",
    refine: "refining",
    prepare: "preparing",
  };
  return known[stage] ?? stage.replaceAll("_", " ");
}

/** As many digits as it takes to compare scores at a glance. */
export function scoreText(score: number): string {
  const size = Math.abs(score);
  if (size !== 0 && size < 0.001) return score.toExponential(0);
  return score.toFixed(size >= 100 ? 0 : 3);
}

/** "AN" of "ann novak"; at most two letters. */
export function initials(name: string): string {
  const words = name.split(/[\s._-]+/).filter(Boolean);
  const letters = words.length > 1 ? [words[0], words.at(-1)] : [words[0]];
  return letters.map((word) => word?.[0]?.toUpperCase() ?? "").join("");
}

/** All that a tile shows, in words. */
export function tileWords(row: ShapeRow, scoreName: string | null, now: number): string {
  const said = [row.source_key, STATE_WORDS[row.state]];
  if (row.failed_stage !== null) said.push(`${stageWords(row.failed_stage)} failed`);
  if (row.author_name !== null) said.push(`by ${row.author_name}`);
  if (row.score !== null && scoreName !== null) said.push(`${scoreName} ${scoreText(row.score)}`);
  if (row.model_version !== null) said.push(`model ${row.model_version}`);
  for (const holder of row.held_by) {
    if (Date.parse(holder.expires_at) > now) said.push(`${holder.name} is working on it`);
  }
  return said.join(", ");
}
