import { useInfiniteQuery } from "@tanstack/react-query";
import { useState } from "react";
import { ROLE_WORDS } from "../../../app/session/session";
import { Badge, Button, Checkbox, type Column, DataTable, Notice, Panel, Time } from "../../../components";
import { count } from "../../../components/numbers";
import { LoadMore } from "../../operations/LoadMore";
import { type Token, tokensQuery } from "./queries";
import { RevokeDialog } from "./RevokeDialog";
import { tokenState } from "./tokenState";

/** Tokens and browsers' sessions: whose, what they allow, and ending them. */
export function TokensPanel() {
  const [showsAll, setShowsAll] = useState(false);
  const [revoking, setRevoking] = useState<Token | null>(null);
  const tokens = useInfiniteQuery(tokensQuery);
  const all = tokens.data?.pages.flatMap((page) => page.items) ?? [];
  const rows = all.filter(
    (token) => showsAll || (!token.is_session && tokenState(token, Date.now()) === "good"),
  );
  return (
    <Panel
      title="Tokens"
      description="Revoking one ends the browser sessions that came from it, too."
      actions={<Checkbox label="Show ended ones and sessions" isChecked={showsAll} onChange={setShowsAll} />}
      isFlush
    >
      {tokens.error && !tokens.data ? (
        <Notice kind="error" title="Tokens could not be read">
          {tokens.error.message}
        </Notice>
      ) : (
        <DataTable
          caption="Tokens"
          columns={columnsOf(setRevoking)}
          rows={rows}
          keyOf={(token) => token.id}
          empty={tokens.isPending ? "Reading…" : "No token is good now."}
        />
      )}
      <LoadMore pages={tokens} />
      {revoking && <RevokeDialog token={revoking} onClose={() => setRevoking(null)} />}
    </Panel>
  );
}

function columnsOf(onRevoke: (token: Token) => void): readonly Column<Token>[] {
  return [
    {
      id: "person",
      header: "Person",
      cell: ({ person_name }) => <span title={person_name}>{person_name}</span>,
    },
    { id: "role", header: "Role", cell: ({ role }) => ROLE_WORDS[role] },
    {
      id: "scope",
      header: "Opens",
      cell: ({ scope }) => (scope === null ? "All" : count(scope.length, "collection")),
    },
    {
      id: "note",
      header: "Note",
      isWide: true,
      cell: ({ note, is_session }) => <span title={note}>{is_session ? "Browser session" : note}</span>,
    },
    {
      id: "used",
      header: "Last used",
      cell: ({ last_used_at }) => (last_used_at ? <Time at={last_used_at} /> : "never"),
    },
    { id: "ends", header: "Ends", cell: (token) => <Ending token={token} /> },
    {
      id: "actions",
      header: <span className="unseen">Actions</span>,
      cell: (token) =>
        tokenState(token, Date.now()) === "good" && (
          <Button
            size="small"
            variant="danger"
            aria-label={`Revoke token ${token.id} of ${token.person_name}`}
            onClick={() => onRevoke(token)}
          >
            Revoke
          </Button>
        ),
    },
  ];
}

function Ending({ token }: { token: Token }) {
  const state = tokenState(token, Date.now());
  if (state === "revoked") return <Badge tone="bad">Revoked</Badge>;
  if (state === "expired") return <Badge>Expired</Badge>;
  return <Time at={token.expires_at} />;
}
