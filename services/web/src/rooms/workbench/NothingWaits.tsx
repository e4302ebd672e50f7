import { useState } from "react";
import { Link } from "wouter";
import { useCollection } from "../../app/CollectionContext";
import { useServiceEvents } from "../../app/events/useServiceEvents";
import { roomAddress } from "../../app/roomAddress";
import { Button, Notice } from "../../components";

/** The queue is empty for this person. Says so when something may have come in. */
export function NothingWaits({ onCheck }: { onCheck: () => void }) {
  const { id } = useCollection();
  const [isNews, setNews] = useState(false);
  useServiceEvents(id, (event) => {
    if (event.kind === "queue" || event.kind === "shape") setNews(true);
  });
  return (
    <Notice
      kind="empty"
      title={isNews ? "The queue has changed" : "Nothing waits for you"}
      actions={
        <>
          <Button variant="primary" onClick={onCheck}>
            {isNews ? "Take the next shape" : "Check again"}
          </Button>
          <Link href={roomAddress(id, "table")}>Choose shapes in the table</Link>
        </>
      }
    >
      {isNews
        ? "There may be a shape for you now."
        : "All shapes are labelled, or with other people. New ones come when somebody gives one back, and when more are ingested."}
    </Notice>
  );
}
