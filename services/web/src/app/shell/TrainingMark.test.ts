import { describe, expect, it } from "vitest";
import type { Schemas } from "../../api/client";
import { foremost } from "./TrainingMark";

const job = (id: number, kind: Schemas["JobOut"]["kind"]) => ({ id, kind }) as Schemas["JobOut"];

describe("the job that the bar shows", () => {
  it("is the training, if there is one", () =>
    expect(foremost([job(2, "export"), job(1, "train")])?.id).toBe(1));
  it("is the newest else", () => expect(foremost([job(2, "export"), job(1, "refine")])?.id).toBe(2));
  it("is none while the machine rests", () => expect(foremost([])).toBeUndefined());
});
