import { Notice, Panel, Skeleton } from "../../../components";
import { bytes, count } from "../../../components/numbers";
import type { Ops } from "../queries";
import styles from "./StoragePanel.module.css";

/** Below it, long work may end for want of space. */
const SCARCE_BYTES = 5e9;

/** What the workspace takes, of all collections, and what is left. */
export function StoragePanel({ ops, className }: { ops: Ops | undefined; className?: string | undefined }) {
  return (
    <Panel
      title="Storage"
      className={className}
      description="Of the whole workspace, with all its collections."
    >
      {ops ? <Figures ops={ops} /> : <Skeleton height={96} />}
    </Panel>
  );
}

function Figures({ ops: { disk, blocks } }: { ops: Ops }) {
  return (
    <div className={styles.figures}>
      <dl className={styles.row}>
        <Figure name="Catalog" value={bytes(disk.database_bytes)} />
        <Figure name="Arrays" value={bytes(disk.array_bytes)} />
        <Figure name="Free" value={disk.free_bytes === null ? "not a local disk" : bytes(disk.free_bytes)} />
      </dl>
      {disk.free_bytes !== null && disk.free_bytes < SCARCE_BYTES && (
        <Notice kind="warning" title="The disk is almost full">
          Free some, or sweep what nothing needs with <code>partwise gc</code>.
        </Notice>
      )}
      {blocks.length > 0 && (
        <section>
          <h3 className={styles.heading}>Arrays, by what is in them</h3>
          <dl className={styles.row}>
            {blocks.map((block) => (
              <Figure
                key={block.kind}
                name={block.kind.replaceAll("_", " ")}
                value={bytes(block.bytes)}
                note={count(block.blocks, "block")}
              />
            ))}
          </dl>
        </section>
      )}
    </div>
  );
}

function Figure({ name, value, note }: { name: string; value: string; note?: string }) {
  return (
    <div>
      <dt className={styles.name}>{name}</dt>
      <dd className={styles.value}>{value}</dd>
      {note && <dd className={styles.name}>{note}</dd>}
    </div>
  );
}
