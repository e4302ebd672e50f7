import { describe, expect, it } from "vitest";
import { hasRole, type Me, type Role } from "./session";

const somebody = (role: Role): Me => ({
  person_id: 1,
  name: "Ann",
  role,
  scope: null,
  is_session: true,
  expires_at: "2030-01-01T00:00:00Z",
});

describe("roles", () => {
  it("may do what those before them may", () => expect(hasRole(somebody("operator"), "reviewer")).toBe(true));
  it("may do what they are", () => expect(hasRole(somebody("operator"), "operator")).toBe(true));
  it("may not do what those after them may", () =>
    expect(hasRole(somebody("operator"), "admin")).toBe(false));
});
