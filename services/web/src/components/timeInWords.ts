/** Times and durations as people say them. */

const MINUTE_S = 60;
const HOUR_S = 3600;
const DAY_S = 86_400;
const JUST_NOW_S = 5;

/** "3 min ago", "in 2 h". Times in milliseconds since 1970. */
export function ageInWords(atMs: number, nowMs: number): string {
  const seconds = (nowMs - atMs) / 1000;
  if (Math.abs(seconds) < JUST_NOW_S) return "just now";
  const words = durationInWords(Math.abs(seconds));
  return seconds > 0 ? `${words} ago` : `in ${words}`;
}

/** "45 s", "12 min", "3 h 20 min", "5 days": the two largest units at most. */
export function durationInWords(seconds: number): string {
  if (seconds < 1) return "under 1 s";
  if (seconds < MINUTE_S) return `${Math.floor(seconds)} s`;
  if (seconds < HOUR_S) return `${Math.floor(seconds / MINUTE_S)} min`;
  if (seconds < DAY_S) {
    const hours = Math.floor(seconds / HOUR_S);
    const minutes = Math.floor((seconds % HOUR_S) / MINUTE_S);
    return minutes === 0 ? `${hours} h` : `${hours} h ${minutes} min`;
  }
  const days = Math.floor(seconds / DAY_S);
  return days === 1 ? "1 day" : `${days} days`;
}

/** Date and time of day in the reader's own way of writing them. */
export function exactTime(at: string): string {
  return new Date(at).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}
