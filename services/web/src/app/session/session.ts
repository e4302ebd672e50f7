/** Beginning and ending a browser's session. The cookie is the service's; this page never sees it. */
import { api, body, type Schemas } from "../../api/client";
import type { Credential } from "./secret";

export type Me = Schemas["Me"];
export type Role = Me["role"];

const ROLES: readonly Role[] = ["annotator", "reviewer", "operator", "admin"];

export const ROLE_WORDS: Readonly<Record<Role, string>> = {
  annotator: "Annotator",
  reviewer: "Reviewer",
  operator: "Operator",
  admin: "Administrator",
};

/** Whether somebody may do what this role may: each may do all that those before it may. */
export function hasRole(me: Me, role: Role): boolean {
  return ROLES.indexOf(me.role) >= ROLES.indexOf(role);
}

export function logIn(credential: Credential): Promise<Me> {
  return body(api.POST("/api/v1/login", { body: credential }));
}

export async function logOut(): Promise<void> {
  await api.POST("/api/v1/logout");
}
