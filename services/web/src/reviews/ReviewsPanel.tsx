import { useState } from "react";
import { Segmented } from "../components";
import { AcceptedInBulk } from "./AcceptedInBulk";
import { Disagreements } from "./Disagreements";
import { OpenReviews } from "./OpenReviews";
import styles from "./Reviews.module.css";

type View = "open" | "disagreements" | "accepts";

/** What leads decide: labels that wait for a second look, people who disagree, and how right bulk acceptance was. */
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
          { value: "accepts", label: "Bulk accepts" },
        ]}
        onChange={setView}
      />
      {view === "open" && <OpenReviews collectionId={collectionId} />}
      {view === "disagreements" && <Disagreements collectionId={collectionId} />}
      {view === "accepts" && <AcceptedInBulk collectionId={collectionId} />}
    </div>
  );
}
