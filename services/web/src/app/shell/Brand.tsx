import styles from "./Brand.module.css";

/** The mark and the name. In narrow bars only the mark is seen. */
export function Brand() {
  return (
    <span className={styles.brand}>
      <svg viewBox="0 0 24 24" className={styles.mark} aria-hidden="true">
        <path className={styles.top} d="M12 2 21 7 12 12 3 7Z" />
        <path className={styles.left} d="M3 8.6 11.2 13.2V22L3 17.4Z" />
        <path className={styles.right} d="M21 8.6 12.8 13.2V22L21 17.4Z" />
      </svg>
      <span className={styles.name}>Partwise</span>
    </span>
  );
}
