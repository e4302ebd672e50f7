/** What the editor of parts asks the service. Every answer is the whole schema as it is then. */
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api, body, type Schemas } from "../api/client";
import { partsQuery } from "../api/queries";

export type Part = Schemas["PartOut"];
type PartSchema = Schemas["PartsOut"];

export interface PartDraft {
  readonly name: string;
  readonly colour: string;
  readonly gloss: string;
  readonly parentId: number | null;
}

const ofCollection = (collectionId: number) => ({ path: { collection_id: collectionId } });
const ofPart = (collectionId: number, partId: number) => ({
  path: { collection_id: collectionId, part_id: partId },
});

/** `partId` null adds a part. */
function save(collectionId: number, partId: number | null, draft: PartDraft): Promise<PartSchema> {
  const { name, colour, gloss, parentId } = draft;
  if (partId === null) {
    const made = { name, colour, gloss, parent_id: parentId };
    const params = ofCollection(collectionId);
    return body(api.POST("/api/v1/collections/{collection_id}/parts", { params, body: made }));
  }
  const changed = { name, colour, gloss, parent_id: parentId ?? 0 };
  const params = ofPart(collectionId, partId);
  return body(api.PATCH("/api/v1/collections/{collection_id}/parts/{part_id}", { params, body: changed }));
}

function remove(collectionId: number, partId: number): Promise<PartSchema> {
  const params = ofPart(collectionId, partId);
  return body(api.DELETE("/api/v1/collections/{collection_id}/parts/{part_id}", { params }));
}

export function useSavePart(collectionId: number) {
  const keep = useKeep(collectionId);
  return useMutation({
    mutationFn: ({ partId, draft }: { partId: number | null; draft: PartDraft }) =>
      save(collectionId, partId, draft),
    onSuccess: keep,
  });
}

export function useRemovePart(collectionId: number) {
  const keep = useKeep(collectionId);
  return useMutation({ mutationFn: (partId: number) => remove(collectionId, partId), onSuccess: keep });
}

function useKeep(collectionId: number) {
  const client = useQueryClient();
  return (schema: PartSchema) => {
    client.setQueryData(partsQuery(collectionId).queryKey, schema);
    void client.invalidateQueries({ queryKey: ["collections"] });
  };
}
