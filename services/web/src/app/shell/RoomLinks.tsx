import { Link } from "wouter";
import { roomAddress } from "../roomAddress";
import { ROOMS } from "../rooms";
import { useMe } from "../session/MeContext";
import { hasRole } from "../session/session";
import styles from "./RoomLinks.module.css";

/** The rooms that the person may enter. */
export function RoomLinks({ collectionId, current }: { collectionId: number; current: string | null }) {
  const me = useMe();
  return (
    <nav aria-label="Rooms" className={styles.rooms}>
      {ROOMS.filter((room) => hasRole(me, room.role)).map(({ path, name, icon: Icon }) => (
        <Link
          key={path}
          href={roomAddress(collectionId, path)}
          className={styles.room}
          title={name}
          aria-current={path === current ? "page" : undefined}
        >
          <Icon aria-hidden="true" />
          <span className={styles.name}>{name}</span>
        </Link>
      ))}
    </nav>
  );
}
