import { expect, it } from "vitest";
import { changeWords } from "./listChange";

it.each([
  [12, "12 new shapes"],
  [1, "1 new shape"],
  [-3, "3 shapes left the list"],
  [0, "The order has changed"],
])("of %i more says %j", (nMore, words) => expect(changeWords({ nMore })).toBe(words));
