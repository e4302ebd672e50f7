import { type ReactNode, useEffect, useState } from "react";
import { Notice, Segmented } from "../../../components";
import type { OpenShape } from "../shape/openShape";
import styles from "./CompareBar.module.css";

type Side = "mine" | "theirs";

export interface CompareBarProps {
  open: OpenShape;
  title: string;
  /** The other labels; null until they are there. */
  theirs: Uint16Array | null;
  theirName: string;
  children: ReactNode;
  actions: ReactNode;
}

/** Two versions of a shape's labels: shows the one or the other on the shape, and what can be done. */
export function CompareBar({ open, title, theirs, theirName, children, actions }: CompareBarProps) {
  const [side, setSide] = useState<Side>("mine");
  useEffect(() => {
    if (side === "mine" || theirs === null) return undefined;
    open.model.setLabels(theirs);
    return () => open.model.setLabels(open.labels);
  }, [open, side, theirs]);
  return (
    <Notice kind="warning" title={title} actions={actions}>
      <p className={styles.text}>{children}</p>
      <Segmented<Side>
        label="Version shown"
        size="small"
        value={side}
        onChange={setSide}
        options={[
          { value: "mine", label: "Show mine" },
          { value: "theirs", label: `Show ${theirName}`, isDisabled: theirs === null },
        ]}
      />
    </Notice>
  );
}
