import { Check, PenTool, Undo2 } from "lucide-react";
import { useState } from "react";
import { useLocation } from "wouter";
import { Button, Notice, TextArea, Time } from "../components";
import { pictureOf } from "../rooms/table/rows/shapeRows";
import { workAddress } from "../rooms/workbench/workAddress";
import { LabelsPicture } from "./LabelsPicture";
import styles from "./Reviews.module.css";
import { type ReviewedShape, useDecision } from "./reviewRequests";
import { detailWords, effortWords, REASON_WORDS } from "./reviewWords";

const MAX_NOTE = 2_000;

/** Labels that wait, beside the model's, with why they wait and what to do about them. */
export function ReviewCard({ collectionId, review, row }: ReviewedShape & { readonly collectionId: number }) {
  const [note, setNote] = useState<string | null>(null);
  const [, navigate] = useLocation();
  const deciding = useDecision(collectionId);
  const { title, why } = REASON_WORDS[review.reason];
  const detail = detailWords(review);
  const effort = effortWords(review.effort);
  const about = { shapeId: row.id, reviewId: review.id };
  return (
    <article className={styles.card} aria-label={row.source_key}>
      <h3 className={styles.name} title={row.source_key}>
        {row.source_key}
      </h3>
      <p className={styles.reason}>
        {title}, <Time at={review.created_at} />
        {effort && ` · ${effort}`}
      </p>
      <div className={styles.pictures}>
        <LabelsPicture
          words={row.author_name ? `By ${row.author_name}` : "These labels"}
          address={pictureOf(row, "confirmed", "")}
        />
        <LabelsPicture words="By the model" address={pictureOf(row, "refined", "")} />
      </div>
      <p>{why}</p>
      {detail && <p>{detail}</p>}
      {note !== null && (
        <TextArea
          label="Note"
          hint="What is wrong, for whoever labels it next."
          autoFocus
          rows={3}
          maxLength={MAX_NOTE}
          value={note}
          onChange={(event) => setNote(event.target.value)}
        />
      )}
      {deciding.error && (
        <Notice kind="error" title="This could not be done">
          {deciding.error.message}
        </Notice>
      )}
      <div className={styles.buttons}>
        <Button icon={<PenTool />} onClick={() => navigate(workAddress(collectionId, [row.id]))}>
          Open
        </Button>
        {note === null ? (
          <>
            <Button icon={<Undo2 />} onClick={() => setNote("")}>
              Send back
            </Button>
            <Button
              variant="primary"
              icon={<Check />}
              isBusy={deciding.isPending}
              onClick={() => deciding.mutate({ what: "accept", ...about })}
            >
              Accept
            </Button>
          </>
        ) : (
          <>
            <Button onClick={() => setNote(null)}>Cancel</Button>
            <Button
              variant="primary"
              isBusy={deciding.isPending}
              disabled={note.trim() === ""}
              onClick={() => deciding.mutate({ what: "reject", ...about, note: note.trim() })}
            >
              Send back
            </Button>
          </>
        )}
      </div>
    </article>
  );
}
