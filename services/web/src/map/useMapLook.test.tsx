// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { useMapLook } from "./useMapLook";

const CAMERA = { x: 0.2, y: 0.3, scale: 4 };

let client: QueryClient;

beforeEach(() => {
  client = new QueryClient();
});
afterEach(cleanup);

/** What changed is told in a task of its own. */
const told = () => new Promise<void>((resolve) => setTimeout(resolve));

function look() {
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={client}>{children}</QueryClientProvider>
  );
  return renderHook(() => useMapLook(3), { wrapper }).result;
}

describe("how the map is looked at", () => {
  it.each([
    ["all else is read anew", () => client.invalidateQueries()],
    ["it is asked for anew", () => client.refetchQueries()],
  ])("stays while %s", async (_when, readAnew) => {
    const shown = look();
    act(() => shown.current[1]({ tool: "lasso", camera: CAMERA }));
    await vi.waitFor(() => expect(shown.current[0].tool).toBe("lasso"));
    await act(readAnew);
    await act(told);
    expect(shown.current[0]).toEqual({ tool: "lasso", colouring: "cluster", camera: CAMERA });
  });
});
