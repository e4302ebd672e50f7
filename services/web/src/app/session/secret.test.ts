import { describe, expect, it } from "vitest";
import { codeOfFragment, takeOneTimeCode } from "./oneTimeCode";
import { credentialOf } from "./secret";

describe("what people paste", () => {
  it("may be a token, with blanks around it", () =>
    expect(credentialOf("  pw_abc \n")).toEqual({ token: "pw_abc" }));
  it("may be an address with a code", () =>
    expect(credentialOf("http://127.0.0.1:8000/#code=a%2Bb")).toEqual({ code: "a+b" }));
  it("may be nothing", () => expect(credentialOf("  ")).toBeNull());
});

describe("a one-time code", () => {
  it("is in a fragment of its own", () => expect(codeOfFragment("#code=xyz")).toBe("xyz"));
  it("is in no other fragment", () => expect(codeOfFragment("#room")).toBeNull());

  it("leaves the address at once, and nothing else does", () => {
    const replaced: string[] = [];
    const window = {
      location: { hash: "#code=xyz", pathname: "/c/3/table", search: "?state=new" },
      history: {
        state: null,
        replaceState: (_state: unknown, _title: string, to: string) => replaced.push(to),
      },
    } as unknown as Window;
    expect(takeOneTimeCode(window)).toBe("xyz");
    expect(replaced).toEqual(["/c/3/table?state=new"]);
  });
});
