import { useInfiniteQuery, useQuery } from "@tanstack/react-query";
import { ChevronLeft, ChevronRight } from "lucide-react";
import { useEffect, useState } from "react";
import { IconButton, Notice } from "../components";
import { whole } from "../components/numbers";
import { AcceptChanged } from "./AcceptChanged";
import { Asked } from "./Asked";
import { ReviewCard } from "./ReviewCard";
import styles from "./Reviews.module.css";
import { reviewCountQuery, reviewsQuery } from "./reviewRequests";

/** Labels that wait for a second look, one after the other. */
export function OpenReviews({ collectionId }: { collectionId: number }) {
  const query = useInfiniteQuery(reviewsQuery(collectionId));
  const [place, setPlace] = useState(0);
  const nOpen = useQuery(reviewCountQuery(collectionId)).data;
  const items = query.data?.pages.flatMap((page) => page.items) ?? [];
  const at = Math.min(place, Math.max(0, items.length - 1));
  const { hasNextPage, fetchNextPage } = query;
  const isNearEnd = at >= items.length - 2;
  useEffect(() => {
    if (isNearEnd && hasNextPage) void fetchNextPage();
  }, [isNearEnd, hasNextPage, fetchNextPage]);
  const shown = items[at];
  return (
    <Asked what="the reviews" query={query}>
      {() =>
        shown === undefined ? (
          <Notice kind="empty" title="Nothing waits for a look">
            Labels come here when they are to be checked, when people disagree, or when their mesh or the
            parts have changed.
          </Notice>
        ) : (
          <>
            <div className={styles.steps}>
              <IconButton
                size="small"
                label="Previous"
                icon={<ChevronLeft />}
                disabled={at === 0}
                onClick={() => setPlace(at - 1)}
              />
              <p>
                {whole(at + 1)} of {whole(Math.max(nOpen ?? 0, items.length))}
              </p>
              <IconButton
                size="small"
                label="Next"
                icon={<ChevronRight />}
                disabled={at === items.length - 1}
                onClick={() => setPlace(at + 1)}
              />
            </div>
            <ReviewCard key={shown.review.id} collectionId={collectionId} {...shown} />
            <AcceptChanged collectionId={collectionId} />
          </>
        )
      }
    </Asked>
  );
}
