import type { Schemas } from "../../../api/client";
import { Button, CopyButton, Dialog, Notice, Time } from "../../../components";
import styles from "./SecretOnce.module.css";

/** A new token's secret. Only its hash is on record, so it cannot be shown again. */
export function SecretOnce({ issued, onClose }: { issued: Schemas["IssuedTokenOut"]; onClose: () => void }) {
  const { token, secret } = issued;
  return (
    <Dialog
      title={`Token for ${token.person_name}`}
      footer={
        <Button variant="primary" onClick={onClose}>
          Done
        </Button>
      }
    >
      <Notice kind="warning" title="Copy it now">
        It is shown this once. If it is lost, revoke it and make another.
      </Notice>
      <div className={styles.secret}>
        <code className={styles.text}>{secret}</code>
        <CopyButton text={secret} label="Copy token" />
      </div>
      <p>
        {token.person_name} pastes it at <strong>{window.location.origin}</strong>. It is good until{" "}
        <Time at={token.expires_at} form="exact" />.
      </p>
    </Dialog>
  );
}
