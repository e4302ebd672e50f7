import { describe, expect, it } from "vitest";
import { isKnownFile, type Transfer, transfersAfter } from "./transfers";

const transfer = (id: number, state: Transfer["state"]): Transfer => ({
  id,
  name: `${id}.off`,
  nBytes: 10,
  nSent: 0,
  state,
  error: null,
});

describe("files on their way", () => {
  it("are added at the end", () => {
    const after = transfersAfter([transfer(1, "sent")], { kind: "add", transfers: [transfer(2, "waiting")] });
    expect(after.map((each) => each.id)).toEqual([1, 2]);
  });

  it("change one by one", () => {
    const before = [transfer(1, "sending"), transfer(2, "waiting")];
    const after = transfersAfter(before, { kind: "change", id: 1, change: { nSent: 4 } });
    expect(after.map((each) => each.nSent)).toEqual([4, 0]);
  });

  it("leave the list once they are through", () => {
    const before = [
      transfer(1, "sent"),
      transfer(2, "sending"),
      transfer(3, "failed"),
      transfer(4, "waiting"),
    ];
    expect(transfersAfter(before, { kind: "clear" }).map((each) => each.id)).toEqual([2, 4]);
  });
});

describe("files that may be sent", () => {
  it.each(["a.off", "A.OBJ", "scans.tar.gz", "b.zip"])("%s", (name) => expect(isKnownFile(name)).toBe(true));
  it.each(["notes.txt", "a.gz", "off"])("not %s", (name) => expect(isKnownFile(name)).toBe(false));
});
