import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { api, body, type Schemas } from "../../../api/client";
import type { RoomProps } from "../../../app/roomAddress";
import { Panel } from "../../../components";
import { ExportForm } from "./ExportForm";
import { ExportList } from "./ExportList";

/** Labels out of the collection: what is wanted, the job that makes it, and the file. */
export function ExportSection({ collectionId }: RoomProps) {
  const [lastId, setLastId] = useState<number | null>(null);
  const exports = useQuery({
    queryKey: ["jobs", collectionId, "exports"],
    queryFn: () =>
      body(
        api.GET("/api/v1/collections/{collection_id}/jobs", {
          params: { path: { collection_id: collectionId }, query: { limit: 200 } },
        }),
      ),
    select: (page: Schemas["JobsPage"]) => page.items.filter((job) => job.kind === "export"),
  });
  return (
    <>
      <Panel
        title="Export labels"
        description="An archive is made by a worker; it can be fetched from below once it is done."
      >
        <ExportForm collectionId={collectionId} onAsked={(job) => setLastId(job.id)} />
      </Panel>
      <ExportList exports={exports} lastId={lastId} />
    </>
  );
}
