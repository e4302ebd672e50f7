/** Numbers as people read them, in English as the rest of the page. */

const INTEGER = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const ONE_DIGIT = new Intl.NumberFormat("en", { maximumFractionDigits: 1 });
const SHORT = new Intl.NumberFormat("en", { notation: "compact", maximumFractionDigits: 1 });

/** 12,345 */
export function whole(value: number): string {
  return INTEGER.format(value);
}

/** 12.3; no digit after the point from 100 on. */
export function decimal(value: number): string {
  return Math.abs(value) >= 100 ? INTEGER.format(value) : ONE_DIGIT.format(value);
}

/** 12.3K, for places where a whole number does not fit; put the whole one in the title. */
export function short(value: number): string {
  return SHORT.format(value);
}

/** "1 shape", "12,345 shapes". */
export function count(n: number, one: string, many = `${one}s`): string {
  return `${whole(n)} ${n === 1 ? one : many}`;
}

/** 0.936 → "93.6%". */
export function percent(share: number): string {
  return `${ONE_DIGIT.format(share * 100)}%`;
}

const BYTE_UNITS = ["B", "kB", "MB", "GB", "TB", "PB"] as const;

/** 12,300,000 → "12.3 MB". */
export function bytes(n: number): string {
  const step = n < 1 ? 0 : Math.min(Math.floor(Math.log10(n) / 3), BYTE_UNITS.length - 1);
  return `${decimal(n / 1000 ** step)} ${BYTE_UNITS[step]}`;
}
