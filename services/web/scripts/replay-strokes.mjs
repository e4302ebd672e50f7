// Replays stroke logs with the page's own code, for the test that holds it to the library's: reads a file of cases, prints
// for each the labels' checksum after every stroke (or that it was refused), and each delta as the page would make it.
import { readFile } from "node:fs/promises";
import { runnerImport } from "vite";

const load = async (path) => (await runnerImport(path, { logLevel: "error" })).module;
const [{ SurfaceMesh }, { LabelEditor }, { makeDelta }, { readLog, readOperation }] = await Promise.all(
  ["geometry/surfaceMesh", "labels/labelEditor", "labels/deltaCodec", "labels/strokeReading"].map((name) =>
    load(`./src/${name}.ts`),
  ),
);

const numbers = (base64, View) => new View(Uint8Array.from(Buffer.from(base64, "base64")).buffer);

async function replayed({ vertices, faces, labels, log: document }) {
  const log = readLog(document);
  const mesh = new SurfaceMesh(numbers(vertices, Float32Array), numbers(faces, Uint32Array), log.mesh_hash);
  const editor = new LabelEditor(mesh, numbers(labels, Uint16Array));
  const checksums = [];
  const deltas = [];
  for (const stroke of log.strokes) {
    const before = editor.labels.slice();
    try {
      editor.apply(await readOperation(stroke));
      checksums.push(editor.sha256());
    } catch {
      checksums.push("refused");
    }
    if (stroke.kind === "delta") {
      const { changed: _, ...json } = await makeDelta(
        stroke.source,
        stroke.parameters,
        before,
        editor.labels,
      );
      deltas.push(json);
    }
  }
  return { base: log.base_sha256, checksums, deltas };
}

const cases = JSON.parse(await readFile(process.argv[2], "utf8"));
console.log(JSON.stringify(await Promise.all(cases.map(replayed))));
