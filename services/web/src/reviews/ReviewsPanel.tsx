import { useState } from "react";
import { Segmented } from "../components";
import { AcceptedInBulk } from "./AcceptedInBulk";
import { Disagreements } from "./Disagreements";
import { OpenReviews } from "./OpenReviews";
import styles from "./Reviews.module.css";
import { SkippedShapes } from "./SkippedShapes";

type View = "open" | "disagreements" | "skips" | "accepts";

/** What leads decide: labels that wait for a second look, people who disagree, what was skipped, and how right bulk acceptance was. */
export function ReviewsPanel({ collectionId }: { collectionId: number }) {
  const [view, setView] = useState<View>("open");
  return (
    <div className={styles.panel}>
      <Segmented
        label="What to look at"
        className={styles.choice ?? ""}
        size="small"
        value={view}
        options={[
          { value: "open", label: "Waiting" },
          { value: "disagreements", label: "Disagreements" },
          { value: "skips", label: "Skipped" },
          { value: "accepts", label: "Bulk accepts" },
        ]}
        onChange={setView}
      />
      {view === "open" && <OpenReviews collectionId={collectionId} />}
      {view === "disagreements" && <Disagreements collectionId={collectionId} />}
      {view === "skips" && <SkippedShapes collectionId={collectionId} />}
      {view === "accepts" && <AcceptedInBulk collectionId={collectionId} />}
    </div>
  );
}
