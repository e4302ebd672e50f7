/** Arrays from the service, also for workers, where there is no window. */
import { problemOf, Unreachable } from "./problem";
import { type Arrays, parseSafetensors } from "./safetensors";

/**
 * Arrays and the strings that describe them, from a path below /api/v1 that answers safetensors.
 *
 * Throws `Problem` for what the service refuses and `Unreachable` where it does not answer.
 */
export async function readArrays(path: string, init: RequestInit = {}): Promise<Arrays> {
  const headers = new Headers(init.headers);
  headers.set("Accept", "application/vnd.safetensors, application/octet-stream");
  const response = await reach(`/api/v1${path}`, { ...init, headers, credentials: "same-origin" });
  if (!response.ok) throw await problemOf(response);
  return parseSafetensors(await response.arrayBuffer());
}

async function reach(url: string, init: RequestInit): Promise<Response> {
  try {
    return await fetch(url, init);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Unreachable(error);
  }
}
