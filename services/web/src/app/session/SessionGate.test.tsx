// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Problem } from "../../api/problem";
import { newQueryClient } from "../../api/queries";
import { announceSessionEnd, onSessionBegin } from "../../api/sessionEnd";
import { ToastProvider } from "../../components";
import { useMe } from "./MeContext";
import { SessionGate } from "./SessionGate";

const ME = {
  person_id: 7,
  name: "Ann",
  role: "annotator",
  scope: null,
  is_session: true,
  expires_at: "2030-01-01T00:00:00Z",
};
const REFUSED = { type: "urn:partwise:problem:unauthenticated", title: "", status: 401, detail: "not valid" };

type Answer = () => unknown;
const { service } = vi.hoisted(() => ({ service: { answers: {} as Record<string, () => unknown> } }));

vi.mock("../../api/client", () => {
  const ask = async (path: string) => ({ data: service.answers[path]?.() });
  return {
    api: { GET: ask, POST: ask },
    body: async (call: Promise<{ data: unknown }>) => (await call).data,
  };
});

/** A service that answers by path. */
function serve(answers: Record<string, Answer>): void {
  service.answers = answers;
}

function refuse(): never {
  throw new Problem(REFUSED);
}

function Inside() {
  const me = useMe();
  return <input aria-label={`Work of ${me.name}`} />;
}

function show(code: string | null = null) {
  render(
    <QueryClientProvider client={newQueryClient()}>
      <ToastProvider>
        <SessionGate code={code}>
          <Inside />
        </SessionGate>
      </ToastProvider>
    </QueryClientProvider>,
  );
}

beforeEach(() => {
  HTMLDialogElement.prototype.showModal ??= function open(this: HTMLDialogElement) {
    this.open = true;
  };
  HTMLDialogElement.prototype.close ??= function close(this: HTMLDialogElement) {
    this.open = false;
  };
});
afterEach(() => {
  cleanup();
});

describe("the session", () => {
  it("lets somebody in who is logged in", async () => {
    serve({ "/api/v1/me": () => ME });
    show();
    expect(await screen.findByLabelText("Work of Ann")).toBeDefined();
  });

  it("asks all others to log in, and lets them in with a token", async () => {
    serve({
      "/api/v1/me": refuse,
      "/api/v1/login": () => ME,
    });
    show();
    fireEvent.change(await screen.findByLabelText("Token or login link"), { target: { value: "pw_1" } });
    fireEvent.click(screen.getByRole("button", { name: "Log in" }));
    expect(await screen.findByLabelText("Work of Ann")).toBeDefined();
  });

  it("says what to do about a token that is not good", async () => {
    serve({
      "/api/v1/me": refuse,
      "/api/v1/login": refuse,
    });
    show();
    fireEvent.change(await screen.findByLabelText("Token or login link"), { target: { value: "pw_1" } });
    fireEvent.click(screen.getByRole("button", { name: "Log in" }));
    expect((await screen.findByRole("alert")).textContent).toContain("ask for a new one");
  });

  it("logs in with the code of the address, once", async () => {
    let n = 0;
    serve({
      "/api/v1/me": refuse,
      "/api/v1/login": () => {
        n += 1;
        return ME;
      },
    });
    show("one-time");
    await screen.findByLabelText("Work of Ann");
    expect(n).toBe(1);
  });

  it("goes on where somebody is logged in already though the code is used", async () => {
    serve({
      "/api/v1/me": () => ME,
      "/api/v1/login": refuse,
    });
    show("used");
    expect(await screen.findByLabelText("Work of Ann")).toBeDefined();
  });

  it("asks again over the page when it ends, and what was typed stays", async () => {
    serve({
      "/api/v1/me": () => ME,
      "/api/v1/login": () => ME,
    });
    const onBegin = vi.fn();
    const stop = onSessionBegin(onBegin);
    show();
    fireEvent.change(await screen.findByLabelText("Work of Ann"), { target: { value: "half a word" } });
    announceSessionEnd();
    await screen.findByRole("dialog", { name: "Log in again" });
    fireEvent.change(screen.getByLabelText("Token or login link"), { target: { value: "pw_2" } });
    fireEvent.click(screen.getByRole("button", { name: "Log in" }));
    await waitFor(() => expect(screen.queryByRole("dialog")).toBeNull());
    expect(screen.getByLabelText("Work of Ann")).toHaveProperty("value", "half a word");
    expect(onBegin).toHaveBeenCalledOnce();
    stop();
  });

  it("begins a page of their own for another person", async () => {
    serve({
      "/api/v1/me": () => ME,
      "/api/v1/login": () => ({ ...ME, person_id: 8, name: "Bo" }),
    });
    show();
    fireEvent.change(await screen.findByLabelText("Work of Ann"), { target: { value: "half a word" } });
    announceSessionEnd();
    fireEvent.change(await screen.findByLabelText("Token or login link"), { target: { value: "pw_2" } });
    fireEvent.click(screen.getByRole("button", { name: "Log in" }));
    expect(await screen.findByLabelText("Work of Bo")).toHaveProperty("value", "");
  });
});
