/** Prepares meshes off the page's thread, so that the page stays smooth while the next shape is fetched. */
import { type MeshArrays, prepared, transferables } from "./meshPreparation";

self.onmessage = ({ data }: MessageEvent<MeshArrays & { request: number }>) => {
  const preparation = prepared(data);
  self.postMessage({ request: data.request, preparation }, { transfer: transferables(preparation) });
};
