import type { ReactNode } from "react";
import { Button, Notice, Spinner } from "../components";

export interface AskedProps<T> {
  /** What is read, as in "the reviews". */
  readonly what: string;
  readonly query: { data: T | undefined; error: Error | null; refetch: () => unknown };
  readonly children: (data: T) => ReactNode;
}

/** What the service answered, that it is being asked, or why it did not answer. */
export function Asked<T>({ what, query, children }: AskedProps<T>) {
  if (query.data !== undefined) return children(query.data);
  if (query.error === null) return <Spinner label={`Reading ${what}`} />;
  const title = `${what.charAt(0).toUpperCase()}${what.slice(1)} could not be read`;
  const again = <Button onClick={() => void query.refetch()}>Try again</Button>;
  return (
    <Notice kind="error" title={title} actions={again}>
      {query.error.message}
    </Notice>
  );
}
