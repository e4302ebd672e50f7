/** A mesh on its way from the service: first what shows it, then what finds its faces under a pointer. */
import { announceSessionEnd } from "../api/sessionEnd";
import type { SerializedBVH } from "./searchTree";
import type { PreparedSurface } from "./surfacePreparation";

export interface MeshWish {
  readonly meshHash: string;
  /** A shape that has or had the mesh. */
  readonly shapeId: number;
}

/** What the worker tells. status : of the service's refusal; null for any other reason. */
export type MeshMessage =
  | { readonly kind: "surface"; readonly surface: PreparedSurface }
  | { readonly kind: "tree"; readonly tree: SerializedBVH }
  | { readonly kind: "failed"; readonly why: string; readonly status: number | null };

export interface ComingMesh {
  readonly surface: Promise<PreparedSurface>;
  /** Has the tree built, which takes about as long as the surface took. To be called once the surface is there. */
  tree(): Promise<SerializedBVH>;
}

/** Reads one mesh. */
export interface MeshReader {
  read(wish: MeshWish): ComingMesh;
  /** No mesh is wanted after all. */
  end(): void;
}

const UNAUTHENTICATED = 401;
/** Browsers give no reason, such as a version of the page that the service has no more. */
const NOT_BEGUN = "what reads it could not be loaded. Load the page again.";

/** It takes a while until it can read, so it may begin before it is known which mesh is wanted. */
export function newMeshReader(worker: Worker = newWorker()): MeshReader {
  const end = () => worker.terminate();
  // listened to from the first: a worker that cannot begin tells so once
  const surface = message(worker, "surface").then(({ surface }) => surface);
  const tree = message(worker, "tree").then(({ tree }) => tree);
  surface.catch(end);
  tree.then(end, end);
  const read = (wish: MeshWish): ComingMesh => {
    worker.postMessage(wish);
    return {
      surface,
      tree: () => {
        worker.postMessage("tree");
        return tree;
      },
    };
  };
  return { read, end };
}

/** A worker for each mesh: the next one is read while this one is, and nothing is left of it afterwards. */
export function readMesh(wish: MeshWish): ComingMesh {
  return newMeshReader().read(wish);
}

function newWorker(): Worker {
  return new Worker(new URL("./mesh.worker.ts", import.meta.url), { type: "module" });
}

type Told<K extends MeshMessage["kind"]> = Extract<MeshMessage, { kind: K }>;

/** The message of one kind, once the worker tells it. Rejects where the worker fails. */
function message<K extends "surface" | "tree">(worker: Worker, kind: K): Promise<Told<K>> {
  return new Promise((resolve, reject) => {
    worker.addEventListener("error", (event) =>
      reject(new Error(`The shape cannot be shown: ${event.message || NOT_BEGUN}`)),
    );
    worker.addEventListener("message", ({ data }: MessageEvent<MeshMessage>) => {
      if (data.kind === kind) resolve(data as Told<K>);
      else if (data.kind === "failed") {
        if (data.status === UNAUTHENTICATED) announceSessionEnd();
        reject(new Error(data.why));
      }
    });
  });
}
