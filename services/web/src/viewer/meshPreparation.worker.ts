/** Prepares one mesh off the page's thread, so that the page stays smooth meanwhile. */
import { type MeshArrays, prepared, transferables } from "./meshPreparation";

self.onmessage = ({ data }: MessageEvent<MeshArrays>) => {
  const preparation = prepared(data);
  self.postMessage(preparation, { transfer: transferables(preparation) });
};
