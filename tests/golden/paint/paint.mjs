// Paint as a client in JavaScript does it, checked against the golden files beside it: `node paint.mjs`.
import { readFileSync, readdirSync } from "node:fs";

const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; // JavaScript adds from the left, as specified
const minus = (u, v) => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
const cross = (u, v) => [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];

function surface(vertices, faces) {
  const corners = faces.map((face) => face.map((corner) => vertices[corner]));
  const used = corners.flat();
  const extent = [0, 1, 2].map((k) => Math.max(...used.map((p) => p[k])) - Math.min(...used.map((p) => p[k])));
  const owners = new Map();
  const edges = faces.map(([a, b, c]) =>
    [[a, b], [b, c], [c, a]].filter(([p, q]) => p !== q).map(([p, q]) => `${Math.min(p, q)},${Math.max(p, q)}`));
  edges.forEach((keys, face) => keys.forEach((key) => owners.set(key, [...(owners.get(key) ?? []), face])));
  return {
    centroids: corners.map(([a, b, c]) => [0, 1, 2].map((k) => (a[k] + b[k] + c[k]) / 3)),
    normals: corners.map(([a, b, c]) => cross(minus(b, a), minus(c, a))),
    diagonal: Math.sqrt(dot(extent, extent)),
    neighbours: edges.map((keys) => keys.flatMap((key) => owners.get(key))),
  };
}

function painted({ centroids, normals, diagonal, neighbours }, { seeds, radius, min_cosine, closed }) {
  const reach = radius * diagonal;
  const shut = new Set(closed ?? []);
  const result = new Set();
  for (const seed of seeds) {
    const length = Math.sqrt(dot(normals[seed], normals[seed]));
    const isTaken = (face) => {
      const offset = minus(centroids[face], centroids[seed]);
      if (dot(offset, offset) > reach * reach || shut.has(face)) return false;
      if (min_cosine === null || face === seed) return true;
      return dot(normals[face], normals[seed]) >= min_cosine * (length * Math.sqrt(dot(normals[face], normals[face])));
    };
    const taken = new Set(isTaken(seed) ? [seed] : []);
    for (const face of taken) for (const next of neighbours[face]) if (!taken.has(next) && isTaken(next)) taken.add(next);
    taken.forEach((face) => result.add(face));
  }
  return [...result].sort((a, b) => a - b);
}

const folder = new URL(".", import.meta.url);
let checked = 0;
for (const name of readdirSync(folder).filter((file) => file.endsWith(".json"))) {
  const { vertices, faces, cases } = JSON.parse(readFileSync(new URL(name, folder), "utf8"));
  const mesh = surface(vertices.map((point) => point.map(Math.fround)), faces);
  for (const stroke of cases) {
    const found = painted(mesh, stroke);
    if (found.join() !== stroke.faces.join()) throw new Error(`${name}: ${JSON.stringify(stroke)} painted ${found}`);
    checked += 1;
  }
}
console.log(`${checked} strokes agree`);
