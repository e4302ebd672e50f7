/**
 * The one module that talks to the service.
 *
 * JSON goes through `api`, whose types come from the service's OpenAPI document; arrays through `fetchArrays`.
 * Both throw `Problem` for what the service refuses and `Unreachable` where it does not answer.
 */
import createClient, { type Middleware } from "openapi-fetch";
import { readArrays } from "./arrays";
import { Problem, problemOf, Unreachable } from "./problem";
import type { Arrays } from "./safetensors";
import type { components, paths } from "./schema";
import { announceSessionEnd } from "./sessionEnd";

export type Schemas = components["schemas"];

const UNAUTHENTICATED = 401;
const LOGIN = "/api/v1/login";

const refusals: Middleware = {
  async onResponse({ response, schemaPath }) {
    if (response.status === UNAUTHENTICATED && schemaPath !== LOGIN) announceSessionEnd();
    if (!response.ok && response.status !== 304) throw await problemOf(response);
  },
  onError({ error }) {
    return error instanceof Problem ? error : new Unreachable(error);
  },
};

export const api = createClient<paths>({ baseUrl: "/", credentials: "same-origin" });
api.use(refusals);

/** The body of an answer that has one. `api` has thrown already where there was none. */
export async function body<T>(call: Promise<{ data?: T | undefined }>): Promise<T> {
  return (await call).data as T;
}

/** Arrays and the strings that describe them, from a path below /api/v1 that answers safetensors. */
export async function fetchArrays(path: string, init: RequestInit = {}): Promise<Arrays> {
  try {
    return await readArrays(path, init);
  } catch (error) {
    if (error instanceof Problem && error.status === UNAUTHENTICATED) announceSessionEnd();
    throw error;
  }
}
