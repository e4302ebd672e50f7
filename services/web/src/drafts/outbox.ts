/** What is kept on this device until the service has it: strokes on their way, and versions that were set aside. */
import type { StrokeJson } from "../labels/strokes";
import type { Observable } from "./observable";

/**
 * Which draft strokes are of. `key` also tells drafts of two workspaces apart that are served, one after the other, at
 * the same address and number their drafts alike.
 */
export interface DraftIdentity {
  readonly key: string;
  readonly draftId: number;
  readonly shapeId: number;
  /** Strokes of one mesh fit no other. */
  readonly meshHash: string;
  readonly collectionId: number;
  readonly personId: number;
}

export function draftIdentity(draft: {
  readonly id: number;
  readonly shape_id: number;
  readonly mesh_hash: string;
  readonly collection_id: number;
  readonly person_id: number;
  readonly created_at: string;
}): DraftIdentity {
  return {
    key: `${draft.id}@${draft.created_at}`,
    draftId: draft.id,
    shapeId: draft.shape_id,
    meshHash: draft.mesh_hash,
    collectionId: draft.collection_id,
    personId: draft.person_id,
  };
}

export type AsideReason =
  /** The person went on with the strokes on record. */
  | "took-theirs"
  /** The draft was closed elsewhere before these could be sent. */
  | "closed"
  /** Two windows wrote at the same place. */
  | "two-windows"
  /** The service refuses them. */
  | "refused";

/** Strokes that are in no log, with those that came before them: so it is known which faces they changed. */
export interface SetAside {
  readonly draft: DraftIdentity;
  readonly before: readonly StrokeJson[];
  readonly at: number;
  readonly reason: AsideReason;
  readonly strokes: readonly StrokeJson[];
}

export interface KeptAside extends SetAside {
  readonly id: number;
}

/** Whether what was set aside can be put on a draft: it is the same person's, on the same mesh of the same shape. */
export function fits({ draft: of }: SetAside, draft: DraftIdentity): boolean {
  return of.personId === draft.personId && of.shapeId === draft.shapeId && of.meshHash === draft.meshHash;
}

export interface Outbox {
  /** How often versions were set aside or forgotten through this outbox. */
  readonly asidesChanged: Observable<number>;
  /** Keeps a stroke. Doing it again changes nothing. Raises what the browser raises where it has no room. */
  add(draft: DraftIdentity, stroke: StrokeJson): Promise<void>;
  /** What is kept of a draft, by place in the log and, for one place, as it came. */
  pending(draftKey: string): Promise<StrokeJson[]>;
  /** The service has these. */
  remove(draftKey: string, strokes: readonly StrokeJson[]): Promise<void>;
  /** Others take the place of some, at once. */
  replace(draft: DraftIdentity, gone: readonly StrokeJson[], come: readonly StrokeJson[]): Promise<void>;
  /** Takes strokes out of their draft and keeps them by themselves, at once. */
  setAside(aside: SetAside): Promise<void>;
  asides(): Promise<KeptAside[]>;
  forgetAside(id: number): Promise<void>;
  /** Drafts that something is kept of. */
  drafts(): Promise<DraftIdentity[]>;
}
