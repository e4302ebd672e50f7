import { useState } from "react";
import { FormDialog, TextArea } from "../../../components";
import styles from "./SkipDialog.module.css";

const REASONS = [
  "The surface is broken",
  "None of the parts fit",
  "I cannot tell the parts apart",
  "Another reason",
] as const;
const OTHER = REASONS[3];
const LONGEST = 1_900;

/** Why a shape cannot be labelled: the person does not get it again. */
export function SkipDialog(props: {
  name: string;
  onSkip: (reason: string) => Promise<void>;
  onClose: () => void;
}) {
  const { name, onSkip, onClose } = props;
  const [reason, setReason] = useState<string>(REASONS[0]);
  const [note, setNote] = useState("");
  const [isBusy, setBusy] = useState(false);
  const [error, setError] = useState<string | null>(null);
  const submit = async () => {
    const words = [reason === OTHER ? "" : reason, note.trim()].filter((each) => each !== "").join(": ");
    if (words === "") {
      setError("Say in a few words what is wrong with it.");
      return;
    }
    setBusy(true);
    try {
      await onSkip(words);
    } catch (refused) {
      setError(refused instanceof Error ? refused.message : String(refused));
      setBusy(false);
    }
  };
  return (
    <FormDialog
      title={`Skip ${name}`}
      size="small"
      verb="Skip this shape"
      isBusy={isBusy}
      onSubmit={() => void submit()}
      onClose={onClose}
    >
      <fieldset className={styles.reasons}>
        <legend className={styles.legend}>You will not get it again. What is wrong with it?</legend>
        {REASONS.map((each) => (
          <label key={each} className={styles.reason}>
            <input type="radio" name="reason" checked={reason === each} onChange={() => setReason(each)} />
            {each}
          </label>
        ))}
      </fieldset>
      <TextArea
        label="Note"
        hint="For whoever looks after the collection"
        error={error}
        rows={2}
        maxLength={LONGEST}
        value={note}
        onChange={(event) => setNote(event.target.value)}
      />
    </FormDialog>
  );
}
