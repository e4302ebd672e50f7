import { Link } from "wouter";
import { type RoomProps, roomAddress } from "../../../app/roomAddress";
import { useMe } from "../../../app/session/MeContext";
import { Panel } from "../../../components";
import { DropArea } from "./DropArea";
import { PrefixForm } from "./PrefixForm";
import { TransferList } from "./TransferList";
import { useTransfers } from "./useTransfers";
import { WaitingUploads } from "./WaitingUploads";

/** Meshes into the collection: from this computer, or from folders that the machine's operator has listed. */
export function FilesSection({ collectionId }: RoomProps) {
  const me = useMe();
  const { transfers, add, cancel, clear } = useTransfers(collectionId);
  return (
    <>
      <Panel
        title="From this computer"
        description="Files that are in the collection already, unchanged, are passed over. One that cannot be read is named and the rest goes on."
      >
        <DropArea onFiles={add} />
        {transfers.length > 0 && <TransferList transfers={transfers} onCancel={cancel} onClear={clear} />}
        <p>
          Workers take files in as jobs:{" "}
          <Link href={roomAddress(collectionId, "operations")}>see how far they are</Link>.
        </p>
      </Panel>
      <WaitingUploads collectionId={collectionId} />
      {me.scope === null && <PrefixForm collectionId={collectionId} />}
    </>
  );
}
