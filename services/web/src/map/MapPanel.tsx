import { useQuery } from "@tanstack/react-query";
import { Problem } from "../api/problem";
import { Button, Notice, Progress, Spinner } from "../components";
import { EmbeddingMap } from "./EmbeddingMap";
import styles from "./EmbeddingMap.module.css";
import type { MapPanelProps } from "./mapPanelProps";
import { mapProgressQuery, mapQuery } from "./mapPoints";

/** The map of a collection, or why there is none. */
export function MapPanel(props: MapPanelProps) {
  const map = useQuery(mapQuery(props.collectionId));
  if (map.data !== undefined) return <EmbeddingMap key={map.dataUpdatedAt} points={map.data} {...props} />;
  if (map.error instanceof Problem && map.error.status === 404) {
    return (
      <Notice kind="empty" title="No map yet">
        It is drawn once shapes are described and the first ones are chosen: an operator runs{" "}
        <code>partwise select</code>.
      </Notice>
    );
  }
  if (map.error !== null) {
    return (
      <Notice
        kind="error"
        isCentred
        title="The map could not be read"
        actions={<Button onClick={() => void map.refetch()}>Try again</Button>}
      >
        {map.error.message}
      </Notice>
    );
  }
  return <Reading collectionId={props.collectionId} />;
}

function Reading({ collectionId }: { collectionId: number }) {
  const share = useQuery(mapProgressQuery(collectionId)).data ?? 0;
  return (
    <div className={styles.reading}>
      <Spinner label="Reading the map" />
      {share > 0 && <Progress label="Reading the map" value={share} />}
    </div>
  );
}
