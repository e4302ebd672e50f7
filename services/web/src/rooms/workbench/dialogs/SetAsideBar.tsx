import { useCallback, useEffect, useState } from "react";
import { Button, Notice, Time } from "../../../components";
import { count } from "../../../components/numbers";
import type { KeptAside } from "../../../drafts/outbox";
import { useObservable } from "../../../drafts/useObservable";
import type { OpenShape } from "../shape/openShape";

/** Strokes of this draft that were set aside: they can be put on top, or dropped for good. */
export function SetAsideBar({ open }: { open: OpenShape }) {
  const { outbox, draft } = open.draft.sender;
  const save = useObservable(open.draft.sender.state);
  const [asides, setAsides] = useState<readonly KeptAside[]>([]);
  const read = useCallback(async () => {
    const all = await outbox.asides().catch(() => []);
    setAsides(all.filter((aside) => aside.draft.key === draft.key));
  }, [outbox, draft.key]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: settling a conflict sets strokes aside
  useEffect(() => void read(), [read, save.kind]);
  const [aside] = asides;
  if (aside === undefined || !open.canEdit) return null;
  const them = aside.strokes.length === 1 ? "it" : "them";
  const forget = async () => {
    await outbox.forgetAside(aside.id);
    await read();
  };
  const putOnTop = async () => {
    await open.putOnTop(aside.first, aside.strokes);
    await forget();
  };
  return (
    <Notice
      title={`${count(aside.strokes.length, "stroke")} set aside`}
      actions={
        <>
          <Button size="small" onClick={() => void putOnTop()}>
            Put on top
          </Button>
          <Button size="small" variant="quiet" onClick={() => void forget()}>
            Drop for good
          </Button>
        </>
      }
    >
      You made {them} <Time at={new Date(aside.at).toISOString()} />, and went on without {them}.
    </Notice>
  );
}
