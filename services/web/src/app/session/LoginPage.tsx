import { Notice } from "../../components";
import { Brand } from "../shell/Brand";
import { LoginForm } from "./LoginForm";
import styles from "./LoginPage.module.css";
import type { Me } from "./session";

/** What somebody sees who is not logged in. `reason` : why not, where that needs to be said. */
export function LoginPage({ onLogin, reason }: { onLogin: (me: Me) => void; reason: string | null }) {
  return (
    <main className={styles.page}>
      <div className={styles.card}>
        <Brand />
        <h1 className={styles.title}>Log in</h1>
        {reason !== null && (
          <Notice kind="warning" title="You are not logged in">
            {reason}
          </Notice>
        )}
        <LoginForm onLogin={onLogin} />
        <details className={styles.help}>
          <summary>No token?</summary>
          <p>
            If you run the service yourself, <code>partwise serve</code> prints an address that logs you in
            once, and <code>partwise token create</code> makes a token for somebody else. Otherwise ask the
            person who runs it.
          </p>
        </details>
      </div>
    </main>
  );
}
