import { Component, type ErrorInfo, type ReactNode } from "react";
import { Button, Notice } from "../../components";

interface Props {
  children: ReactNode;
  /** What is shown has changed: a fault of what was shown before is over. */
  resetKey: string;
}

interface State {
  error: Error | null;
  resetKey: string;
}

/** Keeps a fault of one room from taking the page down, and says what to do. */
export class ErrorBoundary extends Component<Props, State> {
  override state: State = { error: null, resetKey: this.props.resetKey };

  static getDerivedStateFromError(error: Error): Partial<State> {
    return { error };
  }

  static getDerivedStateFromProps(props: Props, state: State): Partial<State> | null {
    return props.resetKey === state.resetKey ? null : { error: null, resetKey: props.resetKey };
  }

  override componentDidCatch(error: Error, info: ErrorInfo): void {
    console.error(error, info.componentStack); // for whoever is asked about it
  }

  override render(): ReactNode {
    const { error } = this.state;
    if (error === null) return this.props.children;
    return isOutdated(error) ? (
      <Outdated />
    ) : (
      <Fault error={error} onRetry={() => this.setState({ error: null })} />
    );
  }
}

/** A part of the page that could not be loaded: usually the service has a newer build. */
function isOutdated(error: Error): boolean {
  return /dynamically imported module|module script failed|preload CSS/i.test(error.message);
}

function Outdated() {
  return (
    <Notice
      kind="warning"
      isCentred
      title="This part of the page could not be loaded"
      actions={
        <Button variant="primary" onClick={() => window.location.reload()}>
          Load the page again
        </Button>
      }
    >
      The service has been updated, or cannot be reached. Strokes that are not sent yet are kept in this
      browser.
    </Notice>
  );
}

function Fault({ error, onRetry }: { error: Error; onRetry: () => void }) {
  return (
    <Notice
      kind="error"
      isCentred
      title="Something went wrong on this page"
      actions={
        <>
          <Button variant="primary" onClick={onRetry}>
            Try again
          </Button>
          <Button onClick={() => window.location.reload()}>Load the page again</Button>
        </>
      }
    >
      Strokes that are not sent yet are kept in this browser. If it happens again, tell whoever runs the
      service: <code>{error.message}</code>
    </Notice>
  );
}
