import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Plus } from "lucide-react";
import { useState } from "react";
import { useLocation } from "wouter";
import { api, body } from "../../../api/client";
import { collectionsQuery } from "../../../api/queries";
import { roomAddress } from "../../../app/roomAddress";
import { Button, type ButtonVariant, FormDialog, Input, TextArea } from "../../../components";
import { partNamesOf } from "./partNames";

/** A button that makes a collection with its first parts, and opens its settings, where files are added. */
export function NewCollection({ variant = "primary" }: { variant?: ButtonVariant }) {
  const [isOpen, setOpen] = useState(false);
  return (
    <>
      <Button variant={variant} icon={<Plus />} onClick={() => setOpen(true)}>
        New collection
      </Button>
      {isOpen && <NewCollectionDialog onClose={() => setOpen(false)} />}
    </>
  );
}

function NewCollectionDialog({ onClose }: { onClose: () => void }) {
  const [name, setName] = useState("");
  const [partText, setPartText] = useState("");
  const parts = partNamesOf(partText);
  const queries = useQueryClient();
  const [, navigate] = useLocation();
  const creation = useMutation({
    mutationFn: () =>
      body(api.POST("/api/v1/collections", { body: { name: name.trim(), parts: [...parts] } })),
    onSuccess: async (made) => {
      await queries.invalidateQueries({ queryKey: collectionsQuery.queryKey });
      onClose();
      navigate(roomAddress(made.id, "settings"));
    },
  });
  return (
    <FormDialog
      title="New collection"
      verb="Create collection"
      isReady={name.trim() !== "" && parts.length > 0}
      isBusy={creation.isPending}
      onSubmit={() => creation.mutate()}
      onClose={onClose}
    >
      <Input
        label="Name"
        value={name}
        maxLength={200}
        required
        onChange={(event) => setName(event.target.value)}
      />
      <TextArea
        label="Parts"
        hint="One a line, in the order annotators see them. Colours, descriptions and more parts can be set later."
        error={creation.error?.message}
        rows={6}
        value={partText}
        placeholder={"seat\nback\nleg"}
        onChange={(event) => setPartText(event.target.value)}
      />
    </FormDialog>
  );
}
