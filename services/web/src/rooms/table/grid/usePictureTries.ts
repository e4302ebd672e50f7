/** Whether a picture is there, and asking again for one that is not: it may be drawn soon, or the service be back. */
import { useEffect, useState } from "react";

const FIRST_MS = 4_000;
const LONGEST_MS = 60_000;

interface Missing {
  readonly address: string;
  readonly nTries: number;
}

export function usePictureTries(address: string | null): {
  readonly isMissing: boolean;
  setMissing(address: string): void;
} {
  const [missing, setMissing] = useState<Missing | null>(null);
  const isMissing = missing !== null && missing.address === address;
  useEffect(() => {
    if (missing === null || !isMissing) return undefined;
    // Beside the page, so that what stands in for the picture stays until there is one.
    const picture = new Image();
    picture.onload = () => setMissing(null);
    picture.onerror = () => setMissing({ ...missing, nTries: missing.nTries + 1 });
    const wait = Math.min(LONGEST_MS, FIRST_MS * 2 ** missing.nTries);
    const timer = window.setTimeout(() => {
      picture.src = missing.address;
    }, wait);
    return () => {
      window.clearTimeout(timer);
      picture.onload = null;
      picture.onerror = null;
      picture.removeAttribute("src");
    };
  }, [missing, isMissing]);
  return { isMissing, setMissing: (failed) => setMissing({ address: failed, nTries: 0 }) };
}
