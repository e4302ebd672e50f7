import { Button, Notice, Progress } from "../../../components";
import type { HeldState } from "../desk/heldShape";
import styles from "./LoadingShape.module.css";

const STEPS = { mesh: { at: 1, words: "Loading the surface" }, labels: { at: 2, words: "Loading labels" } };
const N_STEPS = 3;

/** How far a shape is on its way, over its view; the surface shows as soon as it is there. */
export function LoadingShape(props: {
  state: Exclude<HeldState, { step: "ready" }>;
  onRetry: () => void;
  onGiveUp: () => void;
}) {
  const { state, onRetry, onGiveUp } = props;
  if (state.step === "failed") {
    return (
      <div className={styles.over}>
        <Notice
          kind="error"
          isCentred
          title="This shape could not be opened"
          actions={
            <>
              <Button variant="primary" onClick={onRetry}>
                Try again
              </Button>
              <Button onClick={onGiveUp}>Give it back</Button>
            </>
          }
        >
          {state.why}
        </Notice>
      </div>
    );
  }
  const { at, words } = STEPS[state.step];
  return (
    <div className={styles.corner} role="status">
      <span>{words}…</span>
      <Progress label={words} value={at} max={N_STEPS} className={styles.bar ?? ""} />
    </div>
  );
}
