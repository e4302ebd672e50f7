/**
 * What the workbench needs first, asked for while its code is still on its way: the shape in hand, and its surface.
 *
 * Small, and without three.js, so that it is there before all else.
 */
import { type Claims, type Lease, type LeaseApi, leaseApi } from "../../../drafts/leaseApi";
import type { Renewed } from "../../../drafts/leaseKeeper";
import {
  type ComingMesh,
  type MeshReader,
  type MeshWish,
  newMeshReader,
  readMesh,
} from "../../../viewer/meshReader";
import { MAX_HELD } from "./desk";

export class HeadStart {
  readonly #collectionId: number;
  readonly #shapeIds: readonly number[];
  readonly #meshes = new Map<string, ComingMesh>();
  #held: Promise<Renewed<Lease>[]> | null;
  #named: Promise<Claims> | null;

  /** shapeIds : asked for by name; none for those that the person has in hand. */
  constructor(collectionId: number, shapeIds: readonly number[]) {
    const reader = newMeshReader();
    this.#collectionId = collectionId;
    this.#shapeIds = shapeIds.slice(0, MAX_HELD);
    this.#named = shapeIds.length > 0 ? leaseApi.named(collectionId, [...this.#shapeIds]) : null;
    this.#held = leaseApi.held(collectionId);
    this.#held.catch(() => {}); // who asks for it asks again
    const inHand = this.#named?.then(({ leases }) => leases) ?? this.#held;
    inHand.then(
      (leases) => this.#readFirst(leases, reader),
      () => reader.end(),
    );
  }

  /** The service, which has been asked already for what is wanted first. What failed is asked again. */
  readonly leases: LeaseApi = {
    ...leaseApi,
    held: (collectionId) => {
      const asked = collectionId === this.#collectionId ? this.#held : null;
      this.#held = null;
      return asked?.catch(() => leaseApi.held(collectionId)) ?? leaseApi.held(collectionId);
    },
    named: (collectionId, shapeIds) => {
      const isSame = collectionId === this.#collectionId && shapeIds.join() === this.#shapeIds.join();
      const asked = isSame ? this.#named : null;
      this.#named = null;
      return (
        asked?.catch(() => leaseApi.named(collectionId, shapeIds)) ?? leaseApi.named(collectionId, shapeIds)
      );
    },
  };

  /** The mesh, which may be on its way already. */
  readonly mesh = (wish: MeshWish): ComingMesh => {
    const coming = this.#meshes.get(keyOf(wish));
    this.#meshes.delete(keyOf(wish));
    return coming ?? readMesh(wish);
  };

  #readFirst(leases: readonly Renewed<Lease>[], reader: MeshReader): void {
    const lease = leases.find((each) => !each.lease.is_prefetched)?.lease;
    if (lease === undefined || lease.mesh_hash === null) reader.end();
    else {
      const wish = { meshHash: lease.mesh_hash, shapeId: lease.shape_id };
      this.#meshes.set(keyOf(wish), reader.read(wish));
    }
  }
}

function keyOf({ meshHash, shapeId }: MeshWish): string {
  return `${shapeId} ${meshHash}`;
}
