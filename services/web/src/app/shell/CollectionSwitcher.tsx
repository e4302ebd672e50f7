import { useQuery } from "@tanstack/react-query";
import { ChevronsUpDown } from "lucide-react";
import { useLocation } from "wouter";
import { collectionsQuery } from "../../api/queries";
import { Menu, MenuChoice, MenuHeading } from "../../components";
import type { Collection } from "../CollectionContext";
import { roomAddress } from "../roomAddress";
import styles from "./CollectionSwitcher.module.css";

/** Which collection is shown, and the others; one stays in the same room. */
export function CollectionSwitcher({ collection, room }: { collection: Collection; room: string | null }) {
  const collections = useQuery(collectionsQuery);
  const [, navigate] = useLocation();
  const trigger = (
    <>
      <span className="unseen">Collection: </span>
      <span className={styles.name} title={collection.name}>
        {collection.name}
      </span>
      <ChevronsUpDown className={styles.arrows} aria-hidden="true" />
    </>
  );
  return (
    <div className={styles.switcher}>
      <Menu label={`Collection: ${collection.name}`} trigger={trigger} className={styles.trigger}>
        <MenuHeading>Collections</MenuHeading>
        {(collections.data?.items ?? []).map((each) => (
          <MenuChoice
            key={each.id}
            isChecked={each.id === collection.id}
            onSelect={() => navigate(roomAddress(each.id, room ?? "table"))}
          >
            {each.name}
          </MenuChoice>
        ))}
      </Menu>
    </div>
  );
}
