import { useSyncExternalStore } from "react";
import type { Observable } from "./observable";

const NEVER = () => () => {};

/** The value of an observable, followed. */
export function useObservable<T>(observable: Observable<T>): T {
  return useSyncExternalStore(observable.subscribe, observable.get);
}

/** The same where there may be none. */
export function useObservableOr<T, F>(observable: Observable<T> | null | undefined, fallback: F): T | F {
  return useSyncExternalStore<T | F>(observable?.subscribe ?? NEVER, observable?.get ?? (() => fallback));
}
