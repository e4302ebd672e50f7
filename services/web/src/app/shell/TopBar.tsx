import { Link } from "wouter";
import type { Collection } from "../CollectionContext";
import { Brand } from "./Brand";
import { CollectionSwitcher } from "./CollectionSwitcher";
import { ConnectionMark } from "./ConnectionMark";
import { PersonMenu } from "./PersonMenu";
import { RoomLinks } from "./RoomLinks";
import styles from "./TopBar.module.css";
import { TrainingMark } from "./TrainingMark";

/** The bar above every room. Without a collection there are no rooms to go to. */
export function TopBar({ collection, room }: { collection: Collection | null; room: string | null }) {
  return (
    <header className={styles.bar}>
      <Link href="/" className={styles.home} aria-label="Partwise, all collections">
        <Brand />
      </Link>
      {collection && <CollectionSwitcher collection={collection} room={room} />}
      {collection && <RoomLinks collectionId={collection.id} current={room} />}
      <div className={styles.end}>
        {collection && <TrainingMark collectionId={collection.id} />}
        <ConnectionMark />
        <PersonMenu room={room} />
      </div>
    </header>
  );
}
