/** What kinds of jobs are called. */
import type { Schemas } from "../../api/client";

export type JobKind = Schemas["JobOut"]["kind"];

export const JOB_WORDS: Readonly<Record<JobKind, { name: string; doing: string; meaning: string }>> = {
  preprocess: {
    name: "Prepare shapes",
    doing: "Preparing shapes",
    meaning: "Describes shapes that are new or were put back, and draws their pictures.",
  },
  train: { name: "Train", doing: "Training", meaning: "Trains a model on all confirmed shapes." },
  evaluate: {
    name: "Score shapes",
    doing: "Scoring shapes",
    meaning: "Predicts the labels of all shapes with the newest model, and how sure it is.",
  },
  refine: {
    name: "Refine predictions",
    doing: "Refining predictions",
    meaning: "Moves the boundaries of predicted parts to where the surface bends.",
  },
  export: { name: "Export", doing: "Exporting", meaning: "Writes labelled shapes as files." },
  ingest: { name: "Add files", doing: "Adding files", meaning: "Reads meshes into the collection." },
  select: {
    name: "Draw the map anew",
    doing: "Drawing the map",
    meaning: "Compares all shapes anew, and chooses some of each kind to be labelled first.",
  },
  refill: {
    name: "Refill the queue",
    doing: "Refilling the queue",
    meaning: "Follows a change of how many labels each shape gets.",
  },
};
