import { useMutation } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";
import { Problem } from "../../api/problem";
import { Button, Input } from "../../components";
import styles from "./LoginForm.module.css";
import { type Credential, credentialOf } from "./secret";
import { logIn, type Me } from "./session";

/** Logs in with a token, or with an address that has a one-time code. */
export function LoginForm({ onLogin }: { onLogin: (me: Me) => void }) {
  const [pasted, setPasted] = useState("");
  const [isMissing, setMissing] = useState(false);
  const login = useMutation({
    mutationFn: (credential: Credential) => logIn(credential),
    onSuccess: onLogin,
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const credential = credentialOf(pasted);
    setMissing(credential === null);
    if (credential !== null) login.mutate(credential);
  };
  return (
    <form onSubmit={submit} className={styles.form}>
      <Input
        label="Token or login link"
        type="password"
        autoComplete="off"
        autoCapitalize="none"
        spellCheck={false}
        value={pasted}
        autoFocus
        placeholder="pw_…"
        hint="Whoever runs this service gives you one. It begins with pw_ or is an address with #code= in it."
        error={isMissing ? "Paste your token first." : login.error && wordsForLogin(login.error)}
        onChange={(event) => setPasted(event.target.value)}
      />
      <Button type="submit" variant="primary" isBusy={login.isPending}>
        Log in
      </Button>
    </form>
  );
}

/** Why a login was refused, and what to do. The service gives one answer for all secrets that are not good. */
export function wordsForLogin(error: Error): string {
  if (error instanceof Problem && error.status === 401) {
    return "This token or link is not valid: it may be mistyped, have expired or been revoked, and links work only once. Paste it whole, or ask for a new one.";
  }
  return error.message;
}
