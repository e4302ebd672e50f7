import { type Column, DataTable, Notice, Panel } from "../../../components";
import { bytes, whole } from "../../../components/numbers";
import type { Ops } from "../queries";
import styles from "./StoragePanel.module.css";

type Block = Ops["blocks"][number];

/** Below it, long work may end for want of space. */
const SCARCE_BYTES = 5e9;

const COLUMNS: readonly Column<Block>[] = [
  { id: "kind", header: "Blocks of", isWide: true, cell: ({ kind }) => kind.replaceAll("_", " ") },
  { id: "blocks", header: "Blocks", isNumber: true, cell: ({ blocks }) => whole(blocks) },
  { id: "bytes", header: "Size", isNumber: true, cell: (row) => bytes(row.bytes) },
];

/** What the workspace takes, of all collections, and what is left. */
export function StoragePanel({ ops, className }: { ops: Ops | undefined; className?: string | undefined }) {
  const disk = ops?.disk;
  return (
    <Panel
      title="Storage"
      className={className}
      description="Of the whole workspace, with all its collections."
      isFlush
    >
      {disk && (
        <dl className={styles.figures}>
          <Figure name="Catalog" value={bytes(disk.database_bytes)} />
          <Figure name="Arrays" value={bytes(disk.array_bytes)} />
          <Figure
            name="Free"
            value={disk.free_bytes === null ? "not a local disk" : bytes(disk.free_bytes)}
          />
        </dl>
      )}
      {disk && disk.free_bytes !== null && disk.free_bytes < SCARCE_BYTES && (
        <div className={styles.notice}>
          <Notice kind="warning" title="The disk is almost full">
            Free some, or sweep what nothing needs with <code>partwise gc</code>.
          </Notice>
        </div>
      )}
      <DataTable
        caption="Blocks"
        columns={COLUMNS}
        rows={ops?.blocks ?? []}
        keyOf={({ kind }) => kind}
        empty={ops ? "Nothing is stored yet." : "Reading…"}
      />
    </Panel>
  );
}

function Figure({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt className={styles.name}>{name}</dt>
      <dd className={styles.value}>{value}</dd>
    </div>
  );
}
