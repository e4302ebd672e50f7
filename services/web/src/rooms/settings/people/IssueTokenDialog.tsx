import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { api, body, type Schemas } from "../../../api/client";
import { FormDialog } from "../../../components";
import { NewTokenFields, type TokenWish, USUAL_WISH } from "./NewTokenFields";
import type { Person } from "./queries";
import { SecretOnce } from "./SecretOnce";

/** Makes a token for a person: role, collections and how long it is good; then shows its secret, once. */
export function IssueTokenDialog({ person, onClose }: { person: Person; onClose: () => void }) {
  const [wish, setWish] = useState<TokenWish>(USUAL_WISH);
  const queries = useQueryClient();
  const issuing = useMutation({
    mutationFn: () => body(api.POST("/api/v1/tokens", { body: requestOf(person, wish) })),
    onSuccess: () => queries.invalidateQueries({ queryKey: ["tokens"] }),
  });
  if (issuing.data) return <SecretOnce issued={issuing.data} onClose={onClose} />;
  return (
    <FormDialog
      title={`New token for ${person.name}`}
      verb="Make token"
      isReady={wish.scope === null || wish.scope.length > 0}
      isBusy={issuing.isPending}
      onSubmit={() => issuing.mutate()}
      onClose={onClose}
    >
      <NewTokenFields wish={wish} onChange={setWish} error={issuing.error?.message ?? null} />
    </FormDialog>
  );
}

function requestOf(person: Person, { role, scope, days, note }: TokenWish): Schemas["NewTokenIn"] {
  return { person_id: person.id, role, scope: scope === null ? null : [...scope], days, note: note.trim() };
}
