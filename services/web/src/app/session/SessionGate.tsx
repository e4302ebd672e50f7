import { useQuery, useQueryClient } from "@tanstack/react-query";
import { type ReactNode, useEffect, useState } from "react";
import { Problem } from "../../api/problem";
import { meQuery } from "../../api/queries";
import { onSessionEnd } from "../../api/sessionEnd";
import { Button, Notice } from "../../components";
import { Opening } from "../shell/Opening";
import { enterAs } from "./enterAs";
import { LoginDialog } from "./LoginDialog";
import { wordsForLogin } from "./LoginForm";
import { LoginPage } from "./LoginPage";
import { MeContext } from "./MeContext";
import type { Me } from "./session";
import { useOneTimeLogin } from "./useOneTimeLogin";

/** Shows the page to whoever is logged in, the login to all others, and the login over the page once a session ends. */
export function SessionGate({ code, children }: { code: string | null; children: ReactNode }) {
  const queries = useQueryClient();
  const login = useOneTimeLogin(code);
  const me = useQuery({ ...meQuery, enabled: !login.isPending });
  const [isEnded, setEnded] = useState(false);
  useEffect(() => onSessionEnd(() => setEnded(true)), []);

  const enter = (next: Me) => {
    enterAs(queries, next);
    setEnded(false);
  };
  if (me.data !== undefined) {
    return (
      <MeContext value={me.data}>
        <Keyed key={me.data.person_id}>{children}</Keyed>
        {isEnded && <LoginDialog name={me.data.name} onLogin={enter} />}
      </MeContext>
    );
  }
  if (me.error instanceof Problem && me.error.status === 401) {
    return <LoginPage onLogin={enter} reason={login.error && wordsForLogin(login.error)} />;
  }
  if (me.error) return <Unavailable error={me.error} onRetry={() => void me.refetch()} />;
  return <Opening />;
}

/** Another person begins with a page of their own. */
function Keyed({ children }: { children: ReactNode }) {
  return children;
}

function Unavailable({ error, onRetry }: { error: Error; onRetry: () => void }) {
  return (
    <main>
      <Notice
        kind="error"
        isCentred
        title="The service does not answer"
        actions={<Button onClick={onRetry}>Try again</Button>}
      >
        {error.message} If it stays so, ask whoever runs the service.
      </Notice>
    </main>
  );
}
