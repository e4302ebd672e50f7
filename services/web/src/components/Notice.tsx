import { CircleAlert, Info, TriangleAlert } from "lucide-react";
import type { ReactNode } from "react";
import { classes } from "./classes";
import styles from "./Notice.module.css";

export type NoticeKind = "info" | "empty" | "warning" | "error";

export interface NoticeProps {
  kind?: NoticeKind;
  title: string;
  /** What to do. */
  children?: ReactNode;
  /** Buttons or links that do it. */
  actions?: ReactNode;
  /** In the middle of what would have been there, rather than a strip. "empty" always is. */
  isCentred?: boolean;
}

const ICONS = { info: Info, empty: Info, warning: TriangleAlert, error: CircleAlert };

/** Says what is, why, and what to do about it. An error is announced. */
export function Notice({
  kind = "info",
  title,
  children,
  actions,
  isCentred = kind === "empty",
}: NoticeProps) {
  const Icon = ICONS[kind];
  return (
    <div
      className={classes(styles.notice, styles[kind], isCentred && styles.centred)}
      role={kind === "error" ? "alert" : undefined}
    >
      {kind !== "empty" && <Icon className={styles.icon} aria-hidden="true" />}
      <div className={styles.words}>
        <div className={styles.said}>
          <p className={styles.title}>{title}</p>
          {children !== undefined && <div className={styles.text}>{children}</div>}
        </div>
        {actions !== undefined && <div className={styles.actions}>{actions}</div>}
      </div>
    </div>
  );
}
