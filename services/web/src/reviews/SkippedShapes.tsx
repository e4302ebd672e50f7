import { useInfiniteQuery } from "@tanstack/react-query";
import { Link } from "wouter";
import { Notice, Time } from "../components";
import { LoadMore } from "../rooms/operations/LoadMore";
import { workAddress } from "../rooms/workbench/workAddress";
import { Asked } from "./Asked";
import styles from "./Reviews.module.css";
import { skipsQuery } from "./skipsQuery";

/** Shapes that people gave back for good: what they say is often wrong with the shape, or with the parts. */
export function SkippedShapes({ collectionId }: { collectionId: number }) {
  const query = useInfiniteQuery(skipsQuery(collectionId));
  const items = query.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <Asked what="the skipped shapes" query={query}>
      {() =>
        items.length === 0 ? (
          <Notice kind="empty" title="Nothing was skipped">
            Who cannot label a shape skips it, and says why. It goes to somebody else then.
          </Notice>
        ) : (
          <>
            <ul className={styles.list}>
              {items.map((each) => (
                <li key={`${each.shape_id} ${each.person_id} ${each.skipped_at}`} className={styles.card}>
                  <h3 className={styles.name} title={each.source_key}>
                    <Link href={workAddress(collectionId, [each.shape_id])}>{each.source_key}</Link>
                  </h3>
                  <p>{each.reason}</p>
                  <p className={styles.reason}>
                    {each.person_name}, <Time at={each.skipped_at} />
                  </p>
                </li>
              ))}
            </ul>
            <LoadMore pages={query} />
          </>
        )
      }
    </Asked>
  );
}
