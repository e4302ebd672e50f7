import { useQuery } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { useSearch } from "wouter";
import { partsQuery } from "../../api/queries";
import { RoomHeading } from "../../app/RoomHeading";
import type { RoomProps } from "../../app/roomAddress";
import { useMe } from "../../app/session/MeContext";
import { Button, Notice, Spinner } from "../../components";
import { useObservable, useObservableOr } from "../../drafts/useObservable";
import { type OpenedDesk, useDesk } from "./desk/useDesk";
import { NothingWaits } from "./NothingWaits";
import { namedShapes } from "./namedShapes";
import type { Part } from "./parts";
import { ToolShelf } from "./tools/toolSettings";
import { Workbench } from "./Workbench";
import styles from "./WorkbenchRoom.module.css";

const NO_PARTS: readonly Part[] = [];

/** Where shapes are labelled. `?shapes=3,4` in the address asks for these; without, the queue hands out the next. */
export function WorkbenchRoom({ collectionId }: RoomProps) {
  const me = useMe();
  const named = namedShapes(useSearch());
  const schema = useQuery(partsQuery(collectionId));
  const [shelf] = useState(() => new ToolShelf(localStorage));
  const parts = schema.data?.parts ?? NO_PARTS;
  const partIds = useMemo(() => schema.data?.parts.map((part) => part.id) ?? null, [schema.data]);
  const { start } = useObservable(shelf.settings);
  const opened = useDesk(collectionId, me.person_id, named, { partIds, start });
  if (schema.error) {
    return (
      <Centred>
        <Notice
          kind="error"
          isCentred
          title="The parts could not be read"
          actions={<Button onClick={() => void schema.refetch()}>Try again</Button>}
        >
          {schema.error.message}
        </Notice>
      </Centred>
    );
  }
  return <Opened opened={opened} parts={parts} shelf={shelf} />;
}

function Opened(props: { opened: OpenedDesk | null; parts: readonly Part[]; shelf: ToolShelf }) {
  const { opened, parts, shelf } = props;
  const state = useObservableOr(opened?.desk.state, null);
  if (opened === null || state === null || state.phase === "opening") {
    return (
      <Centred>
        <Spinner label="Getting your next shape…" />
      </Centred>
    );
  }
  const { desk } = opened;
  if (state.phase === "empty") {
    return (
      <Centred>
        <NothingWaits onCheck={() => void desk.takeNext()} />
      </Centred>
    );
  }
  if (state.phase === "failed" || state.current === null) {
    return (
      <Centred>
        <Notice
          kind="error"
          isCentred
          title="No shape to work on"
          actions={
            <>
              <Button onClick={() => void desk.startAgain()}>Try again</Button>
              <Button onClick={() => void desk.takeNext()}>Take the next of the queue</Button>
            </>
          }
        >
          {state.why}
        </Notice>
      </Centred>
    );
  }
  return <Workbench desk={desk} held={state.current} parts={parts} shelf={shelf} />;
}

function Centred({ children }: { children: React.ReactNode }) {
  return (
    <div className={styles.centred}>
      <RoomHeading title="Workbench" isUnseen />
      {children}
    </div>
  );
}
