import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Keyboard, LogOut, Monitor, Moon, Sun } from "lucide-react";
import { useState } from "react";
import { Menu, MenuChoice, MenuHeading, MenuItem, MenuLine, useToast } from "../../components";
import { SCHEMES, type Scheme } from "../scheme/scheme";
import { useScheme } from "../scheme/useScheme";
import { useMe } from "../session/MeContext";
import { logOut, ROLE_WORDS } from "../session/session";
import styles from "./PersonMenu.module.css";
import { ShortcutSheet } from "./ShortcutSheet";

const SCHEME_WORDS: Readonly<Record<Scheme, { name: string; icon: typeof Sun }>> = {
  system: { name: "As the system", icon: Monitor },
  light: { name: "Light", icon: Sun },
  dark: { name: "Dark", icon: Moon },
};

/** Who one is, how the page looks, and the way out. */
export function PersonMenu({ room }: { room: string | null }) {
  const me = useMe();
  const [scheme, setScheme] = useScheme();
  const [isSheetOpen, setSheetOpen] = useState(false);
  const queries = useQueryClient();
  const toast = useToast();
  const leave = useMutation({
    mutationFn: logOut,
    onSuccess: () => {
      queries.clear();
      window.location.assign("/"); // nothing of this person stays in the page's memory
    },
    onError: (error) => toast({ message: `You are still logged in. ${error.message}`, tone: "bad" }),
  });
  return (
    <>
      <Menu
        label="You and this page"
        alignment="end"
        className={styles.trigger}
        trigger={<Initials name={me.name} />}
      >
        <div className={styles.who} role="presentation">
          <strong className={styles.name} title={me.name}>
            {me.name}
          </strong>
          <span className={styles.role}>{ROLE_WORDS[me.role]}</span>
        </div>
        <MenuLine />
        <MenuHeading>Colours</MenuHeading>
        {SCHEMES.map((each) => {
          const { name, icon: Icon } = SCHEME_WORDS[each];
          return (
            <MenuChoice
              key={each}
              isChecked={each === scheme}
              icon={<Icon />}
              onSelect={() => setScheme(each)}
            >
              {name}
            </MenuChoice>
          );
        })}
        <MenuLine />
        <MenuItem icon={<Keyboard />} onSelect={() => setSheetOpen(true)}>
          Keyboard shortcuts
        </MenuItem>
        <MenuItem icon={<LogOut />} onSelect={() => leave.mutate()}>
          Log out
        </MenuItem>
      </Menu>
      {isSheetOpen && <ShortcutSheet room={room} onClose={() => setSheetOpen(false)} />}
    </>
  );
}

function Initials({ name }: { name: string }) {
  const words = name.trim().split(/[\s._-]+/);
  const letters = [words[0], words.length > 1 ? words.at(-1) : undefined].map(
    (word) => [...(word ?? "")][0] ?? "",
  );
  return (
    <>
      <span aria-hidden="true">{letters.join("").toUpperCase()}</span>
      <span className="unseen">You and this page</span>
    </>
  );
}
