/**
 * SHA-256 in plain TypeScript.
 *
 * The browser's own waits for a promise and is missing where the page is not served from localhost or over https; labels
 * are small enough (50,000 faces: under a millisecond) that neither is worth it.
 */

const ROUND_CONSTANTS = new Uint32Array(64);
const START = new Uint32Array(8);
fillConstants();

/** SHA-256 of labels as little-endian uint16, hex: `partwise.labels.encoding.labels_sha256`. */
export function labelsSha256(labels: Uint16Array): string {
  const bytes = new Uint8Array(2 * labels.length);
  labels.forEach((label, face) => {
    bytes[2 * face] = label & 255;
    bytes[2 * face + 1] = label >>> 8;
  });
  return sha256(bytes);
}

/** SHA-256 as 64 hex digits. FIPS 180-4. */
export function sha256(bytes: Uint8Array): string {
  const padded = new Uint8Array((bytes.length + 72) & ~63);
  padded.set(bytes);
  padded[bytes.length] = 0x80;
  const view = new DataView(padded.buffer);
  view.setBigUint64(padded.length - 8, BigInt(bytes.length) * 8n);
  const state = START.slice();
  const schedule = new Uint32Array(64);
  for (let block = 0; block < padded.length; block += 64) compress(state, schedule, view, block);
  return Array.from(state, (word) => word.toString(16).padStart(8, "0")).join("");
}

function compress(state: Uint32Array, w: Uint32Array, view: DataView, block: number): void {
  for (let t = 0; t < 16; t += 1) w[t] = view.getUint32(block + 4 * t);
  for (let t = 16; t < 64; t += 1) {
    const near = w[t - 2] as number;
    const far = w[t - 15] as number;
    const s1 = rotated(near, 17) ^ rotated(near, 19) ^ (near >>> 10);
    const s0 = rotated(far, 7) ^ rotated(far, 18) ^ (far >>> 3);
    w[t] = s1 + (w[t - 7] as number) + s0 + (w[t - 16] as number);
  }
  let [a, b, c, d, e, f, g, h] = state as unknown as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  for (let t = 0; t < 64; t += 1) {
    const sum1 = rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25);
    const t1 = (h + sum1 + ((e & f) ^ (~e & g)) + (ROUND_CONSTANTS[t] as number) + (w[t] as number)) | 0;
    const t2 = ((rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
    [h, g, f, e, d, c, b, a] = [g, f, e, (d + t1) | 0, c, b, a, (t1 + t2) | 0];
  }
  for (const [place, word] of [a, b, c, d, e, f, g, h].entries())
    state[place] = (state[place] as number) + word;
}

function rotated(word: number, by: number): number {
  return (word >>> by) | (word << (32 - by));
}

/** The first 32 bits of the fractions of square and cube roots of the first primes. */
function fillConstants(): void {
  let n = 0;
  for (let number = 2; n < 64; number += 1) {
    let divisor = 2;
    while (divisor * divisor <= number && number % divisor !== 0) divisor += 1;
    if (divisor * divisor <= number) continue;
    if (n < 8) START[n] = (Math.sqrt(number) % 1) * 2 ** 32;
    ROUND_CONSTANTS[n] = (Math.cbrt(number) % 1) * 2 ** 32;
    n += 1;
  }
}
