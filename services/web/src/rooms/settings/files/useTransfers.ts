import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useReducer, useRef } from "react";
import { uploadFile } from "../../../api/upload";
import { isKnownFile, isUnderWay, type Transfer, transfersAfter } from "./transfers";
import { useIngest } from "./useIngest";

interface Held {
  file: File;
  abort: AbortController;
}

const NO_MESH = "Not a mesh or an archive: OFF, OBJ, PLY, STL, GLB, zip or tar.gz.";

/** Sends files one after the other, and asks for each to be taken in as soon as it is there. */
export function useTransfers(collectionId: number) {
  const queries = useQueryClient();
  const ingest = useIngest(collectionId);
  const [transfers, dispatch] = useReducer(transfersAfter, []);
  const held = useRef(new Map<number, Held>());
  const lastId = useRef(0);
  const isSending = transfers.some((each) => each.state === "sending");
  const next = transfers.find((each) => each.state === "waiting");

  const change = (id: number, part: Partial<Transfer>) => dispatch({ kind: "change", id, change: part });
  const send = async (id: number) => {
    const waiting = held.current.get(id);
    if (!waiting) return;
    change(id, { state: "sending" });
    try {
      const { file, abort } = waiting;
      const onProgress = (nSent: number) => change(id, { nSent });
      const upload = await uploadFile(collectionId, file, { onProgress, signal: abort.signal });
      await ingest.mutateAsync({ upload_id: upload.upload_id });
      change(id, { state: "sent", nSent: file.size });
    } catch (error) {
      const isCancelled = error instanceof DOMException && error.name === "AbortError";
      change(id, {
        state: isCancelled ? "cancelled" : "failed",
        error: isCancelled ? null : (error as Error).message,
      });
    } finally {
      held.current.delete(id);
      void queries.invalidateQueries({ queryKey: ["uploads", collectionId] });
    }
  };
  const latestSend = useRef(send);
  useEffect(() => {
    latestSend.current = send;
  });
  useEffect(() => {
    if (!isSending && next) void latestSend.current(next.id);
  }, [isSending, next]);
  useLeaveWarning(transfers.some(isUnderWay));

  const add = (files: readonly File[]) => {
    const added = files.map((file): Transfer => {
      lastId.current += 1;
      const isGood = isKnownFile(file.name);
      if (isGood) held.current.set(lastId.current, { file, abort: new AbortController() });
      const about = { id: lastId.current, name: file.name, nBytes: file.size, nSent: 0 };
      return { ...about, state: isGood ? "waiting" : "failed", error: isGood ? null : NO_MESH };
    });
    dispatch({ kind: "add", transfers: added });
  };
  const cancel = (id: number) => {
    held.current.get(id)?.abort.abort();
    if (transfers.find((each) => each.id === id)?.state === "waiting") {
      held.current.delete(id);
      change(id, { state: "cancelled" });
    }
  };
  return { transfers, add, cancel, clear: () => dispatch({ kind: "clear" }) };
}

/** A file that is half sent is lost with the page: the browser asks first. */
function useLeaveWarning(isUnderWay: boolean): void {
  useEffect(() => {
    if (!isUnderWay) return undefined;
    const warn = (event: BeforeUnloadEvent) => event.preventDefault();
    window.addEventListener("beforeunload", warn);
    return () => window.removeEventListener("beforeunload", warn);
  }, [isUnderWay]);
}
