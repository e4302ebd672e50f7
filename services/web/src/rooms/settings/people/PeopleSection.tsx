import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { useHasRole, useMe } from "../../../app/session/MeContext";
import { Button, type Column, DataTable, Notice, Panel, Time } from "../../../components";
import { peopleQuery } from "../../operations/queries";
import { AddPerson } from "./AddPerson";
import { IssueTokenDialog } from "./IssueTokenDialog";
import type { Person } from "./queries";
import { TokensPanel } from "./TokensPanel";

/** Who there is, and what lets them in. */
export function PeopleSection() {
  const me = useMe();
  const seesAll = me.scope === null;
  const isAdmin = useHasRole("admin") && seesAll;
  const people = useQuery(peopleQuery);
  const [issuingFor, setIssuingFor] = useState<Person | null>(null);
  const columns: readonly Column<Person>[] = [
    {
      id: "name",
      header: "Name",
      isWide: true,
      cell: ({ id, name }) => (
        <span title={name}>
          {name}
          {id === me.person_id && " (you)"}
        </span>
      ),
    },
    { id: "since", header: "Since", cell: ({ created_at }) => <Time at={created_at} /> },
    ...(isAdmin
      ? [
          {
            id: "actions",
            header: <span className="unseen">Actions</span>,
            cell: (person: Person) => (
              <Button
                size="small"
                aria-label={`New token for ${person.name}`}
                onClick={() => setIssuingFor(person)}
              >
                New token
              </Button>
            ),
          },
        ]
      : []),
  ];
  return (
    <>
      <Panel
        title="People"
        actions={seesAll && <AddPerson onAdded={isAdmin ? setIssuingFor : undefined} />}
        description="A person’s labels carry their name. They come in with a token, which also says what they may do."
        isFlush
      >
        {people.error && !people.data ? (
          <Notice kind="error" title="People could not be read">
            {people.error.message}
          </Notice>
        ) : (
          <DataTable
            caption="People"
            columns={columns}
            rows={people.data?.items ?? []}
            keyOf={(person) => person.id}
            empty={people.isPending ? "Reading…" : "Nobody yet."}
          />
        )}
      </Panel>
      {isAdmin ? <TokensPanel /> : <NotForYou />}
      {issuingFor && <IssueTokenDialog person={issuingFor} onClose={() => setIssuingFor(null)} />}
    </>
  );
}

function NotForYou() {
  return (
    <Notice title="Tokens are given out by administrators">
      Ask one whose token opens all collections, or run <code>partwise token create</code> where the service
      runs.
    </Notice>
  );
}
