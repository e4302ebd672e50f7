/** What stages are called, and what they do. */
const WORDS: Readonly<Record<string, { name: string; meaning: string }>> = {
  mesh: { name: "Read", meaning: "Reads the file and checks the mesh." },
  remesh: {
    name: "Remesh",
    meaning: "Makes a closed surface of the size that people and the model work on.",
  },
  describe: { name: "Describe", meaning: "Computes features of every face, for the model." },
  picture: { name: "Picture", meaning: "Draws what the table shows." },
  evaluate: { name: "Predict", meaning: "Predicts labels with the newest model, and how sure it is." },
  refine: { name: "Refine", meaning: "Moves the boundaries of predictions to where the surface bends." },
};

export function stageName(stage: string): string {
  return WORDS[stage]?.name ?? stage;
}

export function stageMeaning(stage: string): string {
  return WORDS[stage]?.meaning ?? "";
}
