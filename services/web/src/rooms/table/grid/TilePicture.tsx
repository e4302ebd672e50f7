import { Box, CircleAlert, ImageOff } from "lucide-react";
import { useLayoutEffect, useRef } from "react";
import styles from "./ShapeTile.module.css";
import { usePictureTries } from "./usePictureTries";

/** A shape's picture. It is asked for when it comes near, and no longer once it has been scrolled past. */
export function TilePicture({ address, isFailed }: { address: string | null; isFailed: boolean }) {
  const { isMissing, setMissing } = usePictureTries(address);
  const drawn = isMissing ? null : address;
  const image = useRef<HTMLImageElement>(null);
  useLayoutEffect(() => {
    const shown = image.current;
    if (shown === null || drawn === null) return undefined;
    shown.src = drawn;
    // Taking an image out of the page does not stop its download; taking its address does. It has to be taken while
    // the image is in the page, which effects of layout are early enough for: else Chromium keeps the element for good.
    return () => shown.removeAttribute("src");
  }, [drawn]);
  if (drawn === null) {
    const Icon = isFailed ? CircleAlert : address === null ? Box : ImageOff;
    return (
      <span className={styles.noPicture}>
        <Icon aria-hidden="true" />
        <span>{isFailed ? "Failed" : address === null ? "Not prepared yet" : "No picture yet"}</span>
      </span>
    );
  }
  return (
    <img
      ref={image}
      className={styles.picture}
      alt=""
      draggable={false}
      loading="lazy"
      decoding="async"
      fetchPriority="low"
      onError={() => setMissing(drawn)}
    />
  );
}
