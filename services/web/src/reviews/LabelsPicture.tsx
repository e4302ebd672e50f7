import { useState } from "react";
import styles from "./Reviews.module.css";

/** A shape's picture with some labels, and whose they are. */
export function LabelsPicture({ words, address }: { words: string; address: string | null }) {
  const [missing, setMissing] = useState<string | null>(null);
  return (
    <figure className={styles.picture}>
      {address === null || missing === address ? (
        <span className={styles.noPicture}>No picture yet</span>
      ) : (
        <img src={address} alt="" decoding="async" onError={() => setMissing(address)} />
      )}
      <figcaption>{words}</figcaption>
    </figure>
  );
}
