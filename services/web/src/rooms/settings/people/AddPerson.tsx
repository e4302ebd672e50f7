import { useMutation, useQueryClient } from "@tanstack/react-query";
import { UserPlus } from "lucide-react";
import { useState } from "react";
import { api, body } from "../../../api/client";
import { Button, FormDialog, Input } from "../../../components";
import { peopleQuery } from "../../operations/queries";
import type { Person } from "./queries";

/** A button that adds a person; `onAdded` goes on with them, such as to give them a token. */
export function AddPerson({ onAdded }: { onAdded: ((person: Person) => void) | undefined }) {
  const [isOpen, setOpen] = useState(false);
  return (
    <>
      <Button size="small" icon={<UserPlus />} onClick={() => setOpen(true)}>
        Add a person
      </Button>
      {isOpen && (
        <AddDialog
          onClose={() => setOpen(false)}
          onAdded={(person) => {
            setOpen(false);
            onAdded?.(person);
          }}
        />
      )}
    </>
  );
}

function AddDialog({ onClose, onAdded }: { onClose: () => void; onAdded: (person: Person) => void }) {
  const [name, setName] = useState("");
  const queries = useQueryClient();
  const adding = useMutation({
    mutationFn: () => body(api.POST("/api/v1/people", { body: { name: name.trim() } })),
    onSuccess: async (person) => {
      await queries.invalidateQueries({ queryKey: peopleQuery.queryKey });
      onAdded(person);
    },
  });
  return (
    <FormDialog
      title="Add a person"
      size="small"
      verb="Add"
      isReady={name.trim() !== ""}
      isBusy={adding.isPending}
      onSubmit={() => adding.mutate()}
      onClose={onClose}
    >
      <Input
        label="Name"
        hint="As colleagues know them: it is shown beside their labels."
        value={name}
        maxLength={200}
        error={adding.error?.message}
        onChange={(event) => setName(event.target.value)}
      />
    </FormDialog>
  );
}
