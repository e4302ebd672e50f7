/** Typed reading of a JSON object that knows which keys nobody asked for, as `partwise.labels.stroke_fields`. */
import { StrokeFormatError } from "./errors";

export type JsonObject = Readonly<Record<string, unknown>>;

/** Every reader throws StrokeFormatError on a missing or mistyped key. */
export class JsonFields {
  readonly #document: JsonObject;
  readonly #what: string;
  readonly #unread: Set<string>;

  constructor(document: unknown, what: string) {
    if (!isObject(document)) throw new StrokeFormatError(`${what} must be an object but is not`);
    this.#document = document;
    this.#what = what;
    this.#unread = new Set(Object.keys(document));
  }

  text(key: string): string {
    return this.#read(key, "text", (value) => typeof value === "string");
  }

  whole(key: string): number {
    return this.#read(key, "a whole number", Number.isSafeInteger);
  }

  number(key: string): number {
    return this.#read(key, "a finite number", Number.isFinite);
  }

  wholes(key: string): number[] {
    return this.#read(key, "a list of whole numbers", areWholes);
  }

  wholePairs(key: string): [number, number][] {
    const arePairs = (value: unknown) =>
      Array.isArray(value) && value.every((item) => areWholes(item) && item.length === 2);
    return this.#read(key, "a list of pairs of whole numbers", arePairs);
  }

  object(key: string): JsonObject {
    return this.#read(key, "an object", isObject);
  }

  list(key: string): unknown[] {
    return this.#read(key, "a list", Array.isArray);
  }

  /** null where the value is null, else what `read` makes of it. */
  orNull<T>(key: string, read: (key: string) => T): T | null {
    return this.#read<unknown>(key, "there", () => true) === null ? null : read(key);
  }

  /** Throws when the object has keys that no reader asked for. */
  checkAllRead(): void {
    if (this.#unread.size > 0) {
      throw new StrokeFormatError(
        `${this.#what} has unknown keys ${[...this.#unread].join(", ")}; reload the page`,
      );
    }
  }

  #read<T>(key: string, rule: string, isGood: (value: unknown) => boolean): T {
    const value = this.#document[key];
    if (!(key in this.#document)) throw new StrokeFormatError(`${this.#what} must have ${key} but has not`);
    if (!isGood(value)) throw new StrokeFormatError(`${key} of ${this.#what} must be ${rule}`);
    this.#unread.delete(key);
    return value as T;
  }
}

function isObject(value: unknown): value is JsonObject {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function areWholes(value: unknown): value is number[] {
  return Array.isArray(value) && value.every(Number.isSafeInteger);
}
