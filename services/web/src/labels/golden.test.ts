/** Golden strokes, which the library is held to as well: see tests/golden at the repository's root. */
import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { SurfaceMesh } from "../geometry/surfaceMesh";
import { LabelEditor } from "./labelEditor";
import { readLog, readOperation } from "./strokeReading";

const FOLDER = new URL("../../../../tests/golden/strokes/", import.meta.url);
const NAMES = readdirSync(FOLDER)
  .filter((name) => name.endsWith(".json"))
  .sort();

function golden(name: string) {
  const document = JSON.parse(readFileSync(new URL(name, FOLDER), "utf8"));
  const log = readLog(document.log);
  const mesh = new SurfaceMesh(
    Float32Array.from(document.vertices.flat()),
    Uint32Array.from(document.faces.flat()),
    log.mesh_hash,
  );
  return { mesh, log, labels: document.labels_after_each_stroke as number[][] };
}

describe("golden stroke logs", () => {
  it("are there", () => expect(NAMES).toEqual(["v0.json", "v1.json", "v1_without_steps.json"]));

  it.each(NAMES)("%s gives the recorded labels after each stroke", async (name) => {
    const { mesh, log, labels } = golden(name);
    const editor = new LabelEditor(mesh, new Uint16Array(mesh.nFaces));
    expect(editor.sha256()).toBe(log.base_sha256);
    for (const [place, stroke] of log.strokes.entries()) {
      editor.apply(await readOperation(stroke));
      expect([...editor.labels], `stroke ${place}`).toEqual(labels[place]);
    }
  });
});
