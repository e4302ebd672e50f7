import { useInfiniteQuery } from "@tanstack/react-query";
import { Notice, Time } from "../components";
import { count } from "../components/numbers";
import { LoadMore } from "../rooms/operations/LoadMore";
import { Asked } from "./Asked";
import styles from "./Reviews.module.css";
import { acceptsQuery } from "./reviewRequests";
import { falseAcceptWords } from "./reviewWords";

/** What was accepted in bulk, and how much of it is wrong as far as people have checked blindly. */
export function AcceptedInBulk({ collectionId }: { collectionId: number }) {
  const query = useInfiniteQuery(acceptsQuery(collectionId));
  const items = query.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <Asked what="bulk accepts" query={query}>
      {() =>
        items.length === 0 ? (
          <Notice kind="empty" title="Nothing was accepted in bulk yet">
            Select shapes in the table and choose Accept. A random few are labelled again by people who are
            not told, and the false-accept rate shows here.
          </Notice>
        ) : (
          <>
            <ul className={styles.list}>
              {items.map((batch) => (
                <li key={batch.id} className={styles.card}>
                  <h3 className={styles.name}>
                    {count(batch.n_accepted, "shape")}, {batch.segmentation} labels
                  </h3>
                  <p className={styles.reason}>
                    {batch.person_name}, <Time at={batch.accepted_at} />
                  </p>
                  <p>{falseAcceptWords(batch)}</p>
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
