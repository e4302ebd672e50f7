import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/roomAddress";
import { Button, Notice, Skeleton } from "../../components";
import { FailuresPanel } from "./failures/FailuresPanel";
import { JobsPanel } from "./jobs/JobsPanel";
import { KeyFigures } from "./KeyFigures";
import { StoragePanel } from "./machines/StoragePanel";
import { WorkersPanel } from "./machines/WorkersPanel";
import styles from "./OperationsRoom.module.css";
import { PeoplePanel } from "./people/PeoplePanel";
import { LeasesPanel } from "./queue/LeasesPanel";
import { QueuePanel } from "./queue/QueuePanel";
import { SkipsPanel } from "./queue/SkipsPanel";
import { RoundsPanel } from "./rounds/RoundsPanel";
import { StagesPanel } from "./stages/StagesPanel";
import { useOpsHistory } from "./useOpsHistory";

/** How the machine and the people are doing, what has failed, and what to do about it. */
export function OperationsRoom({ collectionId }: RoomProps) {
  const { ops, history } = useOpsHistory(collectionId);
  const hasFigures = ops.data !== undefined || ops.isPending; // or they are on their way
  return (
    <div className={styles.page}>
      <header className={styles.head}>
        <RoomHeading title="Operations" />
      </header>
      {ops.error && (
        <Notice
          kind="error"
          title={ops.data ? "The figures below are not the newest" : "The figures could not be read"}
          actions={<Button onClick={() => void ops.refetch()}>Try again</Button>}
        >
          {ops.error.message}
        </Notice>
      )}
      {ops.data ? <KeyFigures ops={ops.data} /> : !ops.error && <Skeleton height={74} />}
      <div className={styles.grid}>
        {hasFigures && <StagesPanel ops={ops.data} history={history} className={styles.whole} />}
        <JobsPanel collectionId={collectionId} className={styles.whole} />
        {hasFigures && <WorkersPanel ops={ops.data} className={styles.whole} />}
        <FailuresPanel collectionId={collectionId} ops={ops.data} className={styles.whole} />
        {hasFigures && <QueuePanel ops={ops.data} history={history} />}
        <LeasesPanel collectionId={collectionId} />
        <SkipsPanel collectionId={collectionId} className={styles.whole} />
        <PeoplePanel collectionId={collectionId} className={styles.whole} />
        <RoundsPanel collectionId={collectionId} ops={ops.data} className={styles.whole} />
        {hasFigures && <StoragePanel ops={ops.data} className={styles.whole} />}
      </div>
    </div>
  );
}
