import { Search, X } from "lucide-react";
import { useEffect, useRef, useState } from "react";
import { isTyping } from "../../../app/shell/isTyping";
import { classes, IconButton } from "../../../components";
import { MAX_NAME, searchedName } from "../view/tableView";
import styles from "./NameSearch.module.css";

/** Longer than between two keys of somebody who types. */
const PAUSE_MS = 250;
const KEY = "/";

export interface NameSearchProps {
  readonly name: string | null;
  onSearch(name: string | null): void;
}

/** Narrows the list to shapes whose names have this in them, as it is typed. */
export function NameSearch({ name, onSearch }: NameSearchProps) {
  const input = useRef<HTMLInputElement>(null);
  const [text, setText] = useState(name ?? "");
  const typed = searchedName(text);
  const search = useRef(onSearch);
  search.current = onSearch;

  // What was typed is asked for once the typing rests; what came from elsewhere, as from "back", is shown.
  const asked = useRef(name);
  useEffect(() => {
    if (asked.current === name) return;
    asked.current = name;
    setText(name ?? "");
  }, [name]);
  const ask = (wanted: string | null) => {
    if (wanted === asked.current) return;
    asked.current = wanted;
    search.current(wanted);
  };
  const latest = useRef(ask);
  latest.current = ask;
  useEffect(() => {
    const timer = setTimeout(() => latest.current(typed), PAUSE_MS);
    return () => clearTimeout(timer);
  }, [typed]);
  useSearchKey(() => {
    input.current?.focus();
    input.current?.select();
  });

  const clear = () => {
    setText("");
    ask(null);
  };
  return (
    <span className={classes(styles.box, name !== null && styles.set)}>
      <Search aria-hidden="true" />
      <input
        ref={input}
        type="text"
        inputMode="search"
        className={styles.input}
        aria-label="Search names"
        aria-keyshortcuts={KEY}
        placeholder="Search names"
        maxLength={MAX_NAME}
        spellCheck={false}
        autoComplete="off"
        value={text}
        onChange={(event) => setText(event.target.value)}
        onKeyDown={(event) => {
          if (event.key === "Enter") ask(typed);
          else if (event.key === "Escape" && text !== "") clear();
          else if (event.key === "Escape") event.currentTarget.blur();
        }}
      />
      {text === "" ? (
        <span className={styles.key} aria-hidden="true">
          <kbd>{KEY}</kbd>
        </span>
      ) : (
        <IconButton
          size="small"
          label="Clear the search"
          shortcut="Escape"
          icon={<X />}
          onClick={() => {
            clear();
            input.current?.focus();
          }}
        />
      )}
    </span>
  );
}

function useSearchKey(onAsked: () => void): void {
  const latest = useRef(onAsked);
  latest.current = onAsked;
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      const isPlain = !event.ctrlKey && !event.metaKey && !event.altKey && !event.defaultPrevented;
      if (event.key !== KEY || !isPlain || isTyping(event.target)) return;
      if (document.querySelector("dialog:modal") !== null) return;
      event.preventDefault(); // else the key would be typed, or be the browser's own search
      latest.current();
    };
    window.addEventListener("keydown", onKeyDown);
    return () => window.removeEventListener("keydown", onKeyDown);
  }, []);
}
