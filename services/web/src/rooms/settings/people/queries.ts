import { infiniteQueryOptions } from "@tanstack/react-query";
import { api, body, type Schemas } from "../../../api/client";

export type Person = Schemas["PersonOut"];
export type Token = Schemas["TokenOut"];

export const tokensQuery = infiniteQueryOptions({
  queryKey: ["tokens"],
  queryFn: ({ pageParam }) =>
    body(api.GET("/api/v1/tokens", { params: { query: { after: pageParam, limit: 200 } } })),
  initialPageParam: 0,
  getNextPageParam: (page) => (page.next ? Number(page.next) : undefined),
});
