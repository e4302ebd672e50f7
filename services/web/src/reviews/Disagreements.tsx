import { useInfiniteQuery } from "@tanstack/react-query";
import { Link } from "wouter";
import { Badge, Button, Notice, Time } from "../components";
import { percent } from "../components/numbers";
import { LoadMore } from "../rooms/operations/LoadMore";
import { workAddress } from "../rooms/workbench/workAddress";
import { Asked } from "./Asked";
import { LabelsPicture } from "./LabelsPicture";
import styles from "./Reviews.module.css";
import { type Disagreement, disagreementsQuery, useDecision } from "./reviewRequests";
import { effortWords } from "./reviewWords";

/** Shapes that several people labelled too differently, for somebody to say whose labels are right. */
export function Disagreements({ collectionId }: { collectionId: number }) {
  const query = useInfiniteQuery(disagreementsQuery(collectionId));
  const items = query.data?.pages.flatMap((page) => page.items) ?? [];
  return (
    <Asked what="the disagreements" query={query}>
      {() =>
        items.length === 0 ? (
          <Notice kind="empty" title="No disagreements">
            They show where a collection asks for several labels of a shape, and people's differ too much.
          </Notice>
        ) : (
          <>
            <ul className={styles.list}>
              {items.map((each) => (
                <li key={each.review_id}>
                  <DisagreementCard collectionId={collectionId} disagreement={each} />
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

function DisagreementCard(props: { collectionId: number; disagreement: Disagreement }) {
  const { collectionId, disagreement } = props;
  const { shape_id: shapeId, review_id: reviewId } = disagreement;
  const deciding = useDecision(collectionId);
  return (
    <article className={styles.card} aria-label={disagreement.source_key}>
      <h3 className={styles.name} title={disagreement.source_key}>
        <Link href={workAddress(collectionId, [shapeId])}>{disagreement.source_key}</Link>
      </h3>
      <p className={styles.reason}>
        {percent(disagreement.area_agreement)} of the area agrees, parts overlap by{" "}
        {percent(disagreement.part_iou)}, <Time at={disagreement.created_at} />
      </p>
      <ul className={styles.answers} aria-label="Whose labels">
        {disagreement.answers.map((answer) => (
          <li key={answer.id}>
            <LabelsPicture
              words={answer.person_name}
              address={`/api/v1/shapes/${shapeId}/answers/${answer.id}/thumbnail`}
            />
            <p className={styles.reason}>{effortWords(answer.effort)}</p>
            {answer.is_medoid && (
              <Badge title="They are the shape’s as long as nobody decides.">Closest to the others</Badge>
            )}
            <Button
              size="small"
              aria-label={`Take the labels of ${answer.person_name}`}
              isBusy={
                deciding.isPending &&
                deciding.variables?.what === "choose" &&
                deciding.variables.answerId === answer.id
              }
              onClick={() =>
                deciding.mutate({
                  what: "choose",
                  shapeId,
                  reviewId,
                  answerId: answer.id,
                  personName: answer.person_name,
                })
              }
            >
              Take these
            </Button>
          </li>
        ))}
      </ul>
      {deciding.error && (
        <Notice kind="error" title="This could not be done">
          {deciding.error.message}
        </Notice>
      )}
    </article>
  );
}
