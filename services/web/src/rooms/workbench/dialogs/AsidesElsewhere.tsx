import { useQueries } from "@tanstack/react-query";
import { useState } from "react";
import { Button, Notice } from "../../../components";
import type { DraftIdentity, Outbox } from "../../../drafts/outbox";
import { shapeQuery } from "../shape/shapeRequests";
import { useAsides } from "./useAsides";

const MOST_NAMED = 4;

export interface AsidesElsewhereProps {
  outbox: Outbox;
  /** Of the shape in hand. */
  draft: DraftIdentity;
  onTake: (shapeId: number) => void;
}

/** Other shapes of this person's that have strokes set aside: there they can be put on top. */
export function AsidesElsewhere({ outbox, draft, onTake }: AsidesElsewhereProps) {
  const [isLater, setLater] = useState(false);
  const others = useAsides(outbox)
    .map((aside) => aside.draft)
    .filter((of) => of.personId === draft.personId && of.collectionId === draft.collectionId)
    .filter((of) => of.shapeId !== draft.shapeId);
  const meshes = new Map(others.map((of) => [of.shapeId, of.meshHash]));
  const answers = useQueries({ queries: [...meshes.keys()].map(shapeQuery) });
  // another workspace may have been served here, which numbers its shapes alike
  const shapes = answers
    .flatMap(({ data }) => data ?? [])
    .filter(({ id, mesh }) => mesh?.mesh_hash === meshes.get(id))
    .slice(0, MOST_NAMED);
  if (isLater || shapes.length === 0) return null;
  return (
    <Notice
      title="Strokes of other shapes are set aside"
      actions={
        <>
          {shapes.map(({ id, source_key }) => (
            <Button key={id} size="small" onClick={() => onTake(id)}>
              Open {source_key}
            </Button>
          ))}
          <Button size="small" variant="quiet" onClick={() => setLater(true)}>
            Later
          </Button>
        </>
      }
    >
      There they can be put on top, or dropped.
    </Notice>
  );
}
