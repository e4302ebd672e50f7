import { useQuery } from "@tanstack/react-query";
import { api, body } from "../api/client";
import styles from "./EmbeddingMap.module.css";
import { STATE_WORDS } from "./MapLegend";
import { type MapPoints, NO_CLUSTER, POINT_STATES } from "./mapPoints";

export interface HoverCardProps {
  readonly points: MapPoints;
  readonly place: number;
  /** Whether keys have come to it, so that it is to be heard. */
  readonly isAimed: boolean;
}

/** The shape that the pointer or the crosshair rests on. */
export function HoverCard({ points, place, isAimed }: HoverCardProps) {
  const id = points.ids[place] as number;
  const shape = useQuery({
    queryKey: ["shape", id],
    queryFn: async ({ signal }) => {
      await rest(signal);
      return body(api.GET("/api/v1/shapes/{shape_id}", { params: { path: { shape_id: id } }, signal }));
    },
    retry: false,
  }).data;
  const cluster = points.cluster[place] as number;
  const state = POINT_STATES[points.state[place] as number] ?? "new";
  const words = [cluster === NO_CLUSTER ? "" : `Cluster ${cluster + 1}`, STATE_WORDS[state]].filter(Boolean);
  return (
    <>
      {shape && (
        <div className={styles.card} aria-hidden="true">
          <img
            className={styles.cardPicture}
            alt=""
            src={`/api/v1/shapes/${id}/thumbnail?segmentation=${state === "confirmed" ? "confirmed" : "refined"}`}
          />
          <p className={styles.cardName}>{shape.source_key}</p>
          <p className={styles.number}>{words.join(", ")}</p>
        </div>
      )}
      {isAimed && (
        <p className="unseen" role="status">
          {shape && [shape.source_key, ...words].join(", ")}
        </p>
      )}
    </>
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
