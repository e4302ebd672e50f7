/** The desk of a collection, from entering the room to leaving it. */
import { useContext, useEffect, useRef, useState } from "react";
import type { ServiceEvent } from "../../../api/events";
import { onSessionBegin } from "../../../api/sessionEnd";
import { useConnection, useServiceEvents } from "../../../app/events/useServiceEvents";
import { systemClock } from "../../../drafts/clock";
import type { SessionParts } from "../../../drafts/draftSession";
import { browserTabs } from "../../../drafts/editingRight";
import { httpTransport } from "../../../drafts/httpTransport";
import { IndexedDbOutbox } from "../../../drafts/indexedDbOutbox";
import { type Lease, leaseApi } from "../../../drafts/leaseApi";
import type { Renewed } from "../../../drafts/leaseKeeper";
import { Leftovers } from "../../../drafts/leftovers";
import { ReserveOutbox } from "../../../drafts/reserveOutbox";
import { Desk } from "./desk";
import { HeadStartContext } from "./HeadStartContext";
import { HeldShape, type Opening } from "./heldShape";

export interface OpenedDesk {
  readonly desk: Desk;
  /** Something may work again: the network, this tab, this computer, the log in. */
  wake(): void;
}

/** One for the page's life: what the device does not keep is still there when its person comes back to the room. */
const outbox = new ReserveOutbox(new IndexedDbOutbox(), systemClock);

const warnOfLoss = warningOf(outbox);

const PARTS: SessionParts = {
  transport: httpTransport,
  outbox,
  clock: systemClock,
  tabs: browserTabs,
  openDraft: leaseApi.openDraft,
};

/** named : shapes that the address asks for. Null until the room is entered for good. */
export function useDesk(
  collectionId: number,
  personId: number,
  named: readonly number[],
  opening: Opening,
): OpenedDesk | null {
  const latest = useRef(opening);
  latest.current = opening;
  const wanted = named.join(",");
  const ahead = useContext(HeadStartContext);
  const [opened, setOpened] = useState<OpenedDesk | null>(null);
  useEffect(() => {
    const hold = (leased: Renewed<Lease>, isNamed: boolean) =>
      new HeldShape(PARTS, leased, isNamed, ahead?.mesh);
    const desk = new Desk({ leases: ahead?.leases ?? leaseApi, hold }, collectionId, () => latest.current);
    const leftovers = new Leftovers(PARTS, personId, (draft) => desk.isAtWork(draft));
    const wake = () => {
      desk.wake();
      void outbox.storeAgain();
      void leftovers.send();
    };
    desk.onLeft = () => void leftovers.send();
    const ids = wanted === "" ? [] : wanted.split(",").map(Number);
    void desk
      .start(ids)
      .then(() => desk.state.get().current?.seen())
      .then(() => leftovers.send());
    setOpened({ desk, wake });
    const stopWaking = wakeWith(wake);
    window.addEventListener("beforeunload", warnOfLoss); // once, and for the page's life as the outbox is
    return () => {
      stopWaking();
      void desk.close();
    };
  }, [collectionId, personId, wanted, ahead]);
  const connection = useConnection();
  useEffect(() => {
    if (connection === "connected") opened?.wake();
  }, [connection, opened]);
  useServiceEvents(
    collectionId,
    (event) => {
      const shapeId = endedFor(personId, event);
      if (shapeId !== null) void opened?.desk.recheck(shapeId);
    },
    () => opened?.wake(),
  );
  return opened;
}

/** The shape that an event says this person no longer holds, without their doing; null if it says another thing. */
export function endedFor(personId: number, { kind, payload }: ServiceEvent): number | null {
  const isTheirs = kind === "queue" && payload.person_id === personId;
  const isEnd = payload.what === "cleared" || payload.what === "expired";
  return isTheirs && isEnd && typeof payload.shape_id === "number" ? payload.shape_id : null;
}

/** The browser asks before it closes a page that alone has strokes. */
export function warningOf(kept: Pick<ReserveOutbox, "isEmpty">): (event: Event) => void {
  return (event) => {
    if (!kept.isEmpty) event.preventDefault();
  };
}

function wakeWith(wake: () => void): () => void {
  const wakeIfSeen = () => document.visibilityState === "visible" && wake();
  window.addEventListener("online", wake);
  document.addEventListener("visibilitychange", wakeIfSeen);
  const stop = onSessionBegin(wake);
  return () => {
    window.removeEventListener("online", wake);
    document.removeEventListener("visibilitychange", wakeIfSeen);
    stop();
  };
}
