import { useQueries } from "@tanstack/react-query";
import { useState } from "react";
import { Link } from "wouter";
import { Button, Notice } from "../../../components";
import type { DraftIdentity, Outbox } from "../../../drafts/outbox";
import { shapeQuery } from "../shape/shapeRequests";
import { workAddress } from "../workAddress";
import { useAsides } from "./useAsides";

const MOST_NAMED = 8;

/** Other shapes of this person's that have strokes set aside: there they can be put on top. */
export function AsidesElsewhere({ outbox, draft }: { outbox: Outbox; draft: DraftIdentity }) {
  const [isLater, setLater] = useState(false);
  const others = useAsides(outbox)
    .map((aside) => aside.draft)
    .filter((of) => of.personId === draft.personId && of.collectionId === draft.collectionId)
    .filter((of) => of.shapeId !== draft.shapeId);
  const meshes = new Map(others.map((of) => [of.shapeId, of.meshHash]));
  const answers = useQueries({ queries: [...meshes.keys()].slice(0, MOST_NAMED).map(shapeQuery) });
  // another workspace may have been served here, which numbers its shapes alike
  const shapes = answers.flatMap(({ data }) =>
    data !== undefined && data.mesh?.mesh_hash === meshes.get(data.id) ? [data] : [],
  );
  if (isLater || shapes.length === 0) return null;
  return (
    <Notice
      title="Strokes of other shapes are set aside"
      actions={
        <Button size="small" onClick={() => setLater(true)}>
          Later
        </Button>
      }
    >
      Open the shape to put them on top, or to drop them:{" "}
      {shapes.map(({ id, source_key }, place) => (
        <span key={id}>
          {place > 0 && ", "}
          <Link href={workAddress(draft.collectionId, [id])}>{source_key}</Link>
        </span>
      ))}
    </Notice>
  );
}
