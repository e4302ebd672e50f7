import { useEffect, useState } from "react";
import { applyScheme, type Scheme, savedScheme, saveScheme } from "./scheme";

/** The chosen scheme, and how to choose another. Other tabs follow. */
export function useScheme(): [Scheme, (scheme: Scheme) => void] {
  const [scheme, setScheme] = useState(() => savedScheme(localStorage));
  useEffect(() => applyScheme(scheme, document.documentElement), [scheme]);
  useEffect(() => {
    const follow = () => setScheme(savedScheme(localStorage));
    window.addEventListener("storage", follow);
    return () => window.removeEventListener("storage", follow);
  }, []);
  const choose = (next: Scheme) => {
    saveScheme(next, localStorage);
    setScheme(next);
  };
  return [scheme, choose];
}
