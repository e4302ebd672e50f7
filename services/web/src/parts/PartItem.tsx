import { Pencil, Trash2 } from "lucide-react";
import { IconButton } from "../components";
import styles from "./Parts.module.css";
import type { Part } from "./partRequests";

/** Keys 1 to 9 pick the first nine in the workbench. */
const N_KEYS = 9;

export interface PartItemProps {
  readonly part: Part;
  readonly number: number;
  readonly mayChange: boolean;
  onEdit(): void;
  onRemove(): void;
}

export function PartItem({ part, number, mayChange, onEdit, onRemove }: PartItemProps) {
  return (
    <div className={styles.item}>
      <span className={styles.colour} style={{ background: part.colour }} />
      <div className={styles.words}>
        <p className={styles.name} title={part.name}>
          {part.name}
        </p>
        {part.gloss !== "" && <p className={styles.gloss}>{part.gloss}</p>}
      </div>
      {number <= N_KEYS && <kbd title={`Key ${number} picks it in the workbench`}>{number}</kbd>}
      {mayChange && (
        <span className={styles.buttons}>
          <IconButton size="small" label={`Change ${part.name}`} icon={<Pencil />} onClick={onEdit} />
          <IconButton size="small" label={`Remove ${part.name}`} icon={<Trash2 />} onClick={onRemove} />
        </span>
      )}
    </div>
  );
}
