import { ChevronDown } from "lucide-react";
import { Menu, MenuChoice, MenuHeading } from "../../../components";
import { HEAT_GRADIENT } from "../../../viewer/colours";
import styles from "./ShownMenu.module.css";
import { choiceOf, SHOWN_CHOICES, type Shown } from "./shown";

export interface ShownMenuProps {
  /** Of the view, such as "View 2 of 4". */
  view: string;
  shown: Shown;
  /** Why that cannot be shown. */
  why: string | null;
  onChoose: (shown: Shown) => void;
}

/** In the corner of a view: what it shows, and what else it could. */
export function ShownMenu({ view, shown, why, onChoose }: ShownMenuProps) {
  const { name } = choiceOf(shown);
  return (
    <div className={styles.corner}>
      <Menu
        label={`${view} shows: ${name}`}
        alignment="end"
        className={styles.trigger}
        trigger={
          <>
            {name} <ChevronDown aria-hidden="true" />
          </>
        }
      >
        <MenuHeading>Show in this view</MenuHeading>
        {SHOWN_CHOICES.map((choice) => (
          <MenuChoice
            key={choice.shown}
            isChecked={choice.shown === shown}
            onSelect={() => onChoose(choice.shown)}
          >
            {choice.words}
          </MenuChoice>
        ))}
      </Menu>
      {why !== null && (
        <p className={styles.why} role="status">
          {why} The draft is shown.
        </p>
      )}
      {why === null && shown === "uncertainty" && (
        <p className={styles.legend}>
          sure <span className={styles.ramp} style={{ background: HEAT_GRADIENT }} /> unsure
        </p>
      )}
    </div>
  );
}
