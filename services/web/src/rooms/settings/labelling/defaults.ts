/** A collection's settings. The service tells what was set; what was not has these defaults. */
import type { Collection } from "../../../app/CollectionContext";

export interface CollectionSettings {
  labels_per_shape: number;
  agreement: number;
  honeypot_share: number;
  review: boolean;
  train_after: number;
  up: "x" | "y" | "z";
  working_faces: number;
  remesh: "auto" | "never";
}

export const DEFAULTS: CollectionSettings = {
  labels_per_shape: 1,
  agreement: 0.9,
  honeypot_share: 0,
  review: false,
  train_after: 5,
  up: "y",
  working_faces: 10_000,
  remesh: "auto",
};

/** What holds now. A value of another type than its default's is not one that this page knows. */
export function settingsOf(collection: Collection): CollectionSettings {
  const known = Object.entries(DEFAULTS).map(([name, usual]) => {
    const set = collection.settings[name];
    return [name, typeof set === typeof usual ? set : usual];
  });
  return Object.fromEntries(known) as CollectionSettings;
}

/** What differs between two. */
export function changesBetween(
  before: CollectionSettings,
  after: CollectionSettings,
): Partial<CollectionSettings> {
  const names = Object.keys(DEFAULTS) as (keyof CollectionSettings)[];
  return Object.fromEntries(
    names.filter((name) => before[name] !== after[name]).map((name) => [name, after[name]]),
  );
}
