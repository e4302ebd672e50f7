import { useQuery } from "@tanstack/react-query";
import { Problem } from "../api/problem";
import { Button, Notice, Progress, Spinner } from "../components";
import { EmbeddingMap } from "./EmbeddingMap";
import styles from "./EmbeddingMap.module.css";
import type { MapPanelProps } from "./mapPanelProps";
import { mapProgressQuery } from "./mapQueries";
import { useMapPoints } from "./useMapPoints";

/** The map of a collection, or why there is none. */
export function MapPanel(props: MapPanelProps) {
  const { collectionId } = props;
  const { points, error, refetch } = useMapPoints(collectionId);
  if (points !== undefined) return <EmbeddingMap key={collectionId} points={points} {...props} />;
  if (error instanceof Problem && error.status === 404) {
    return (
      <Notice kind="empty" title="No map yet">
        It is drawn by itself once two shapes are prepared, and shapes that come later are added to it.
      </Notice>
    );
  }
  if (error !== null) {
    return (
      <Notice
        kind="error"
        isCentred
        title="The map could not be read"
        actions={<Button onClick={refetch}>Try again</Button>}
      >
        {error.message}
      </Notice>
    );
  }
  return <Reading collectionId={collectionId} />;
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
