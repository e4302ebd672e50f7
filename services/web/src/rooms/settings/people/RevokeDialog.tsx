import { useMutation, useQueryClient } from "@tanstack/react-query";
import { api } from "../../../api/client";
import { Button, Dialog, useToast } from "../../../components";
import type { Token } from "./queries";

export function RevokeDialog({ token, onClose }: { token: Token; onClose: () => void }) {
  const queries = useQueryClient();
  const toast = useToast();
  const revoking = useMutation({
    mutationFn: () => api.DELETE("/api/v1/tokens/{token_id}", { params: { path: { token_id: token.id } } }),
    onSuccess: () => toast({ message: `The token of ${token.person_name} is revoked.`, tone: "good" }),
    onError: (error) => toast({ message: error.message, tone: "bad" }),
    onSettled: () => {
      void queries.invalidateQueries({ queryKey: ["tokens"] });
      onClose();
    },
  });
  return (
    <Dialog
      title="Revoke this token?"
      size="small"
      isAlert
      onClose={onClose}
      footer={
        <>
          <Button onClick={onClose}>Keep it</Button>
          <Button variant="danger" isBusy={revoking.isPending} onClick={() => revoking.mutate()}>
            Revoke
          </Button>
        </>
      }
    >
      <p>
        {token.person_name} is logged out wherever it was used. Strokes that were sent are kept; those that
        were not stay in their browser until they log in with another token. This cannot be undone.
      </p>
    </Dialog>
  );
}
