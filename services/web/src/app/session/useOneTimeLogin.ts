import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { enterAs } from "./enterAs";
import { takeOneTimeCode } from "./oneTimeCode";
import { logIn } from "./session";

export interface OneTimeLogin {
  /** A code is being exchanged: who one is comes after it. */
  isPending: boolean;
  error: Error | null;
}

/** Exchanges the code that came with the address, once, and any that comes while the page is open. */
export function useOneTimeLogin(first: string | null): OneTimeLogin {
  const [code, setCode] = useState(first);
  const queries = useQueryClient();
  useEffect(() => {
    const take = () => {
      const next = takeOneTimeCode(window);
      if (next !== null) setCode(next);
    };
    window.addEventListener("hashchange", take);
    return () => window.removeEventListener("hashchange", take);
  }, []);
  const login = useQuery({
    queryKey: ["me", "one-time login", code],
    queryFn: async () => {
      const me = await logIn({ code: code ?? "" });
      enterAs(queries, me);
      return me;
    },
    enabled: code !== null,
    retry: false,
    staleTime: Number.POSITIVE_INFINITY,
  });
  return { isPending: code !== null && login.isPending, error: login.error };
}
