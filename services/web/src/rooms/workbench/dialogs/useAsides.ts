import { useEffect, useState } from "react";
import type { KeptAside, Outbox } from "../../../drafts/outbox";
import { useObservable } from "../../../drafts/useObservable";

/** All that was set aside on this device, read anew whenever something is set aside or dropped here. */
export function useAsides(outbox: Outbox): readonly KeptAside[] {
  const nChanges = useObservable(outbox.asidesChanged);
  const [asides, setAsides] = useState<readonly KeptAside[]>([]);
  // biome-ignore lint/correctness/useExhaustiveDependencies: the outbox says when its asides changed
  useEffect(() => {
    let isLatest = true;
    outbox.asides().then(
      (all) => isLatest && setAsides(all),
      () => {},
    );
    return () => {
      isLatest = false;
    };
  }, [outbox, nChanges]);
  return asides;
}
