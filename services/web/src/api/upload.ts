/** Files to the service, with how far they are: of what browsers have, only XMLHttpRequest tells that. */
import type { Schemas } from "./client";
import { problemOf, Unreachable } from "./problem";
import { announceSessionEnd } from "./sessionEnd";

export type Upload = Schemas["UploadOut"];

const UNAUTHENTICATED = 401;

export interface UploadOptions {
  onProgress: (nBytesSent: number) => void;
  signal: AbortSignal;
}

/** Sends a file to a collection. Throws as `api` does, and an AbortError if it is called off. */
export function uploadFile(collectionId: number, file: File, options: UploadOptions): Promise<Upload> {
  const request = new XMLHttpRequest();
  request.open("POST", `/api/v1/collections/${collectionId}/uploads?name=${encodeURIComponent(file.name)}`);
  request.setRequestHeader("Content-Type", "application/octet-stream");
  request.upload.addEventListener("progress", (event) => options.onProgress(event.loaded));
  options.signal.addEventListener("abort", () => request.abort());
  return new Promise((resolve, reject) => {
    request.addEventListener("load", () => answerOf(request).then(resolve, reject));
    request.addEventListener("error", () => reject(new Unreachable(request.status)));
    request.addEventListener("abort", () =>
      reject(new DOMException("The upload was called off.", "AbortError")),
    );
    request.send(file);
  });
}

async function answerOf(request: XMLHttpRequest): Promise<Upload> {
  const response = new Response(request.responseText, {
    status: request.status,
    statusText: request.statusText,
  });
  if (response.ok) return response.json();
  if (response.status === UNAUTHENTICATED) announceSessionEnd();
  throw await problemOf(response);
}
