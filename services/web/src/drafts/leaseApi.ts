/** What people hold, asked over HTTP. */
import { api, body, type Schemas } from "../api/client";
import type { Renewed } from "./leaseKeeper";
import type { DraftRecord } from "./transport";

export type Lease = Schemas["LeaseOut"];
export type RefusedClaim = Schemas["RefusedClaim"];

export interface Claims {
  readonly leases: readonly Renewed<Lease>[];
  readonly refused: readonly RefusedClaim[];
}

/** After sleep, a connection that is long gone may look as if it were there. */
const ANSWER_MS = 30_000;

/** The service's time of an answer, by which leases run; this machine's where a proxy drops it. */
function answeredAt(response: Response): number {
  const date = response.headers.get("date");
  return date === null ? Date.now() : Date.parse(date);
}

async function claim(wish: Schemas["Claim"]): Promise<Claims> {
  const { data, response } = await api.POST("/api/v1/queue/claim", { body: wish });
  const { items, refused } = data as Schemas["Claimed"];
  const at = answeredAt(response);
  return { leases: items.map((lease) => ({ lease, at })), refused };
}

export const leaseApi = {
  /** What the caller holds in a collection: the same after a reload. */
  async held(collectionId: number): Promise<Renewed<Lease>[]> {
    const { data, response } = await api.GET("/api/v1/leases");
    const at = answeredAt(response);
    const { items } = data as Schemas["LeasesOut"];
    return items.filter((lease) => lease.collection_id === collectionId).map((lease) => ({ lease, at }));
  },

  /** The next of the queue; null if nothing is left. */
  async next(collectionId: number, isPrefetch: boolean): Promise<Renewed<Lease> | null> {
    const { leases } = await claim({ collection_id: collectionId, shape_ids: [], is_prefetch: isPrefetch });
    return leases[0] ?? null;
  },

  named: (collectionId: number, shapeIds: number[]): Promise<Claims> =>
    claim({ collection_id: collectionId, shape_ids: shapeIds, is_prefetch: false }),

  async renew(leaseId: number, isPrefetched: boolean | null): Promise<Renewed<Lease>> {
    const { data, response } = await api.POST("/api/v1/leases/{lease_id}/heartbeat", {
      params: { path: { lease_id: leaseId } },
      body: { is_prefetched: isPrefetched },
      signal: AbortSignal.timeout(ANSWER_MS),
    });
    return { lease: data as Lease, at: answeredAt(response) };
  },

  async reclaim(collectionId: number, shapeId: number): Promise<Renewed<Lease>> {
    const { leases } = await leaseApi.named(collectionId, [shapeId]);
    return leases[0] as Renewed<Lease>; // by name, a claim that gets nothing is refused
  },

  openDraft: (leaseId: number, baseRevision: number | null): Promise<DraftRecord> =>
    body(
      api.POST("/api/v1/leases/{lease_id}/draft", {
        params: { path: { lease_id: leaseId } },
        body: { base_revision: baseRevision },
      }),
    ),

  async skip(leaseId: number, reason: string): Promise<void> {
    await api.POST("/api/v1/leases/{lease_id}/skip", {
      params: { path: { lease_id: leaseId } },
      body: { reason },
    });
  },

  async release(leaseId: number): Promise<void> {
    await api.POST("/api/v1/leases/{lease_id}/release", { params: { path: { lease_id: leaseId } } });
  },
};

export type LeaseApi = typeof leaseApi;
