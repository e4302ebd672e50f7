import { createContext, type ReactNode, useContext, useEffect, useRef } from "react";
import { useCollection } from "./CollectionContext";
import styles from "./RoomHeading.module.css";

/** How often somebody has gone to another room on this page. 0: it has just been loaded. */
export const NavigationContext = createContext(0);

export interface RoomHeadingProps {
  /** What the browser's tab and the heading say, such as the shape in hand. */
  title: string;
  /** In place of the title as it is shown. */
  children?: ReactNode;
  /** Rooms without space for it keep the heading for screen readers. */
  isUnseen?: boolean;
}

/** The heading of a room: takes the focus when somebody has come here from another room, and names the tab. */
export function RoomHeading({ title, children, isUnseen = false }: RoomHeadingProps) {
  const collection = useCollection();
  const heading = useRef<HTMLHeadingElement>(null);
  const navigations = useContext(NavigationContext);
  useEffect(() => {
    document.title = `${title} · ${collection.name} · Partwise`;
  }, [title, collection.name]);
  useEffect(() => {
    if (navigations > 0) heading.current?.focus();
  }, [navigations]);
  return (
    <h1 ref={heading} tabIndex={-1} className={isUnseen ? "unseen" : styles.heading}>
      {children ?? title}
    </h1>
  );
}
