/** The desk of a collection, from entering the room to leaving it. */
import { useContext, useEffect, useRef, useState } from "react";
import type { ServiceEvent } from "../../../api/events";
import { onSessionBegin } from "../../../api/sessionEnd";
import { useServiceEvents } from "../../../app/events/useServiceEvents";
import { systemClock } from "../../../drafts/clock";
import type { SessionParts } from "../../../drafts/draftSession";
import { browserTabs } from "../../../drafts/editingRight";
import { httpTransport } from "../../../drafts/httpTransport";
import { IndexedDbOutbox } from "../../../drafts/indexedDbOutbox";
import { type Lease, leaseApi } from "../../../drafts/leaseApi";
import type { Renewed } from "../../../drafts/leaseKeeper";
import { sendLeftovers } from "../../../drafts/leftovers";
import { Desk } from "./desk";
import { HeadStartContext } from "./HeadStartContext";
import { HeldShape, type Opening } from "./heldShape";

export interface OpenedDesk {
  readonly desk: Desk;
  readonly parts: SessionParts;
}

function newParts(): SessionParts {
  return {
    transport: httpTransport,
    outbox: new IndexedDbOutbox(),
    clock: systemClock,
    tabs: browserTabs,
    openDraft: leaseApi.openDraft,
  };
}

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
    const parts = newParts();
    const hold = (leased: Renewed<Lease>, isNamed: boolean) =>
      new HeldShape(parts, leased, isNamed, ahead?.mesh);
    const desk = new Desk({ leases: ahead?.leases ?? leaseApi, hold }, collectionId, () => latest.current);
    const ids = wanted === "" ? [] : wanted.split(",").map(Number);
    void desk.start(ids).then(() => sendLeftovers(parts, personId, openKeys(desk)));
    setOpened({ desk, parts });
    const stopWaking = wakeWith(desk);
    return () => {
      stopWaking();
      void desk.close();
    };
  }, [collectionId, personId, wanted, ahead]);
  useServiceEvents(
    collectionId,
    (event) => {
      const shapeId = endedFor(personId, event);
      if (shapeId !== null) void opened?.desk.recheck(shapeId);
    },
    () => opened?.desk.wake(),
  );
  return opened;
}

/** The shape that an event says this person no longer holds, without their doing; null if it says another thing. */
export function endedFor(personId: number, { kind, payload }: ServiceEvent): number | null {
  const isTheirs = kind === "queue" && payload.person_id === personId;
  const isEnd = payload.what === "cleared" || payload.what === "expired";
  return isTheirs && isEnd && typeof payload.shape_id === "number" ? payload.shape_id : null;
}

function openKeys(desk: Desk): Set<string> {
  const { shapes } = desk.state.get();
  return new Set(shapes.flatMap((shape) => shape.open?.draft.sender.draft.key ?? []));
}

/** When something may work again: the network, this tab, this computer, the log in. */
function wakeWith(desk: Desk): () => void {
  const wake = () => desk.wake();
  const wakeIfSeen = () => document.visibilityState === "visible" && desk.wake();
  window.addEventListener("online", wake);
  document.addEventListener("visibilitychange", wakeIfSeen);
  const stop = onSessionBegin(wake);
  return () => {
    window.removeEventListener("online", wake);
    document.removeEventListener("visibilitychange", wakeIfSeen);
    stop();
  };
}
