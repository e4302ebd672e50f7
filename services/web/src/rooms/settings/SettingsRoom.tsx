import { Link, useLocation } from "wouter";
import { RoomHeading } from "../../app/RoomHeading";
import { type RoomProps, roomAddress } from "../../app/roomAddress";
import { useMe } from "../../app/session/MeContext";
import { NewCollection } from "./collections/NewCollection";
import styles from "./SettingsRoom.module.css";
import { SECTIONS, sectionsFor } from "./sections";

/** Collections, files, people: everything that is set up rather than worked on. */
export function SettingsRoom({ collectionId }: RoomProps) {
  const me = useMe();
  const [location] = useLocation();
  const base = roomAddress(collectionId, "settings");
  const sections = sectionsFor(me);
  const wanted = location.slice(base.length + 1).split("/")[0];
  const current = sections.find((each) => each.path === wanted) ?? sections[0] ?? SECTIONS[0];
  return (
    <div className={styles.room}>
      <div className={styles.side}>
        <RoomHeading title="Settings" />
        <nav aria-label="Settings" className={styles.sections}>
          {sections.map(({ path, name }) => (
            <Link
              key={path}
              href={`${base}/${path}`}
              className={styles.section}
              aria-current={path === current.path ? "page" : undefined}
            >
              {name}
            </Link>
          ))}
        </nav>
        {me.scope === null && <NewCollection variant="secondary" />}
      </div>
      <div className={styles.content}>
        <current.View key={current.path} collectionId={collectionId} />
      </div>
    </div>
  );
}
