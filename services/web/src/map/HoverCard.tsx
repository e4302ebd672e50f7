import { useQuery } from "@tanstack/react-query";
import { api, body } from "../api/client";
import styles from "./EmbeddingMap.module.css";
import { type MapPoints, NO_CLUSTER, POINT_STATES } from "./mapPoints";

/** The shape under the pointer, once it rests there. */
export function HoverCard({ points, place }: { points: MapPoints; place: number }) {
  const id = points.ids[place] as number;
  const shape = useQuery({
    queryKey: ["shape", id],
    queryFn: async ({ signal }) => {
      await rest(signal);
      return body(api.GET("/api/v1/shapes/{shape_id}", { params: { path: { shape_id: id } }, signal }));
    },
    retry: false,
  }).data;
  if (shape === undefined) return null;
  const cluster = points.cluster[place] as number;
  const isConfirmed = POINT_STATES[points.state[place] as number] === "confirmed";
  return (
    <div className={styles.card} aria-hidden="true">
      <img
        className={styles.cardPicture}
        alt=""
        src={`/api/v1/shapes/${id}/thumbnail?segmentation=${isConfirmed ? "confirmed" : "refined"}`}
      />
      <p className={styles.cardName}>{shape.source_key}</p>
      {cluster !== NO_CLUSTER && <p className={styles.number}>Cluster {cluster + 1}</p>}
    </div>
  );
}

const REST_MS = 120;

/** Waits a moment, so that shapes that the pointer only passes are not asked for. */
function rest(signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const timer = window.setTimeout(resolve, REST_MS);
    signal.addEventListener("abort", () => {
      window.clearTimeout(timer);
      reject(signal.reason);
    });
  });
}
