import { Dialog } from "../../components";
import { LoginForm } from "./LoginForm";
import type { Me } from "./session";

/** Over the page when a session has ended: what is below it stays as it is. */
export function LoginDialog({ name, onLogin }: { name: string; onLogin: (me: Me) => void }) {
  return (
    <Dialog title="Log in again" size="small">
      <p>
        Your session has ended, {name}. What you have done is kept on this page and goes on once you are
        logged in.
      </p>
      <LoginForm onLogin={onLogin} />
    </Dialog>
  );
}
