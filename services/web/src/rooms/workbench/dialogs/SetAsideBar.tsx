import { Button, Notice, Time } from "../../../components";
import { count } from "../../../components/numbers";
import { fits, type KeptAside } from "../../../drafts/outbox";
import type { OpenShape } from "../shape/openShape";
import { fetchBase } from "../shape/shapeRequests";
import { useCanEdit } from "../shape/useCanEdit";
import { useAsides } from "./useAsides";
import { useTask } from "./useTask";

/** Strokes of this shape that were set aside: they can be put on top, or dropped for good. */
export function SetAsideBar({ open }: { open: OpenShape }) {
  const { outbox, draft } = open.draft.sender;
  const canEdit = useCanEdit(open);
  const aside = useAsides(outbox).find((each) => fits(each, draft));
  const task = useTask();
  if (aside === undefined || !canEdit) return null;
  const them = aside.strokes.length === 1 ? "it" : "them";
  const putOnTop = async () => {
    await putAsideOnTop(open, aside);
    await outbox.forgetAside(aside.id);
  };
  return (
    <Notice
      title={`${count(aside.strokes.length, "stroke")} set aside`}
      actions={
        <>
          <Button size="small" isBusy={task.isBusy} onClick={() => task.run(putOnTop)}>
            Put on top
          </Button>
          <Button
            size="small"
            variant="quiet"
            isBusy={task.isBusy}
            onClick={() => task.run(() => outbox.forgetAside(aside.id))}
          >
            Drop for good
          </Button>
        </>
      }
    >
      You made {them} <Time at={new Date(aside.at).toISOString()} />, and went on without {them}.
    </Notice>
  );
}

async function putAsideOnTop(open: OpenShape, aside: KeptAside): Promise<void> {
  const baseRevision = aside.strokes[0]?.base_revision ?? null;
  const base = await fetchBase(aside.draft.shapeId, baseRevision);
  await open.putOnTop(aside, base);
}
