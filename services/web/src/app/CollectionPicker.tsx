import { useEffect } from "react";
import { Link } from "wouter";
import { Notice, Time } from "../components";
import { NewCollection } from "../rooms/settings/collections/NewCollection";
import type { Collection } from "./CollectionContext";
import styles from "./CollectionPicker.module.css";
import { roomAddress } from "./roomAddress";
import { ROOMS } from "./rooms";
import { useHasRole, useMe } from "./session/MeContext";
import { Shell } from "./shell/Shell";

/** Which collection to open, when there are several; what to do when there is none. */
export function CollectionPicker({ collections }: { collections: readonly Collection[] }) {
  const me = useMe();
  const mayCreate = useHasRole("operator") && me.scope === null;
  useEffect(() => {
    document.title = "Collections · Partwise";
  }, []);
  return (
    <Shell collection={null} room={null}>
      <div className={styles.page}>
        <div className={styles.head}>
          <h1>Collections</h1>
          {mayCreate && <NewCollection />}
        </div>
        {collections.length === 0 ? <None mayCreate={mayCreate} /> : <List collections={collections} />}
      </div>
    </Shell>
  );
}

function List({ collections }: { collections: readonly Collection[] }) {
  return (
    <ul className={styles.list}>
      {collections.map((each) => (
        <li key={each.id}>
          <Link href={roomAddress(each.id, ROOMS[0].path)} className={styles.collection}>
            <span className={styles.name} title={each.name}>
              {each.name}
            </span>
            <span className={styles.made}>
              made <Time at={each.created_at} />
            </span>
          </Link>
        </li>
      ))}
    </ul>
  );
}

function None({ mayCreate }: { mayCreate: boolean }) {
  return (
    <Notice kind="empty" title={mayCreate ? "No collections yet" : "No collection is open to you"}>
      {mayCreate
        ? "A collection holds shapes that are cut into the same parts. Make one, then add files in its settings."
        : "Ask whoever gave you your token to open one to you; it appears here once they have."}
    </Notice>
  );
}
