import { type ReactNode, useId } from "react";
import { classes } from "./classes";
import styles from "./Panel.module.css";

export interface PanelProps {
  title: string;
  /** Beside the title: a figure, buttons, filters. */
  actions?: ReactNode;
  /** One line on what is shown. */
  description?: ReactNode;
  children: ReactNode;
  /** Its content reaches the edges, as tables do. */
  isFlush?: boolean;
  className?: string | undefined;
}

/** A titled part of a page. */
export function Panel({ title, actions, description, children, isFlush = false, className }: PanelProps) {
  const id = useId();
  return (
    <section aria-labelledby={id} className={classes(styles.panel, className)}>
      <header className={styles.header}>
        <h2 id={id} className={styles.title}>
          {title}
        </h2>
        {actions !== undefined && <div className={styles.actions}>{actions}</div>}
      </header>
      {description !== undefined && <p className={styles.description}>{description}</p>}
      <div className={isFlush ? styles.flush : styles.body}>{children}</div>
    </section>
  );
}
