/** Where popovers go: below what they belong to, above it where there is no room, and always within the window. */

const GAP_PX = 6;
const MARGIN_PX = 8;

export type Alignment = "start" | "centre" | "end";

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/** The upper left corner of a popover of this size beside an anchor, in a window of `room`'s size. */
export function cornerBeside(
  size: { readonly width: number; readonly height: number },
  anchor: Box,
  room: { readonly width: number; readonly height: number },
  alignment: Alignment,
): { left: number; top: number } {
  const offset = { start: 0, centre: (anchor.width - size.width) / 2, end: anchor.width - size.width }[
    alignment
  ];
  const below = anchor.top + anchor.height + GAP_PX;
  const above = anchor.top - size.height - GAP_PX;
  const isRoomBelow = below + size.height <= room.height - MARGIN_PX;
  const furthestLeft = Math.max(MARGIN_PX, room.width - size.width - MARGIN_PX);
  return {
    left: Math.min(Math.max(anchor.left + offset, MARGIN_PX), furthestLeft),
    top: isRoomBelow || above < MARGIN_PX ? below : above,
  };
}

/** Moves an open popover to where it belongs. */
export function placeBeside(popover: HTMLElement, anchor: Element, alignment: Alignment): void {
  const room = { width: document.documentElement.clientWidth, height: document.documentElement.clientHeight };
  const { left, top } = cornerBeside(
    popover.getBoundingClientRect(),
    anchor.getBoundingClientRect(),
    room,
    alignment,
  );
  popover.style.left = `${left}px`;
  popover.style.top = `${top}px`;
}
