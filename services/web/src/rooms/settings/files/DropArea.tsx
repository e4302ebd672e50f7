import { Upload } from "lucide-react";
import { type DragEvent, useRef, useState } from "react";
import { Button, classes } from "../../../components";
import styles from "./DropArea.module.css";
import { ACCEPTED } from "./transfers";

/** Files by dropping them, or by the browser's picker. */
export function DropArea({ onFiles }: { onFiles: (files: readonly File[]) => void }) {
  const [isOver, setOver] = useState(false);
  const picker = useRef<HTMLInputElement>(null);
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    onFiles([...event.dataTransfer.files]);
  };
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: dropping is for the mouse; the button inside does the same by key
    <div
      className={classes(styles.area, isOver && styles.over)}
      onDragOver={(event) => {
        event.preventDefault();
        setOver(true);
      }}
      onDragLeave={() => setOver(false)}
      onDrop={drop}
    >
      <Upload className={styles.icon} aria-hidden="true" />
      <p>Drop meshes or archives here</p>
      <p className={styles.formats}>OFF, OBJ, PLY, STL, GLB, or a zip or tar.gz of them</p>
      <Button onClick={() => picker.current?.click()}>Choose files</Button>
      <input
        ref={picker}
        type="file"
        multiple
        accept={ACCEPTED}
        className="unseen"
        tabIndex={-1}
        aria-label="Files to add"
        onChange={(event) => {
          onFiles([...(event.target.files ?? [])]);
          event.target.value = ""; // the same file can be chosen again
        }}
      />
    </div>
  );
}
