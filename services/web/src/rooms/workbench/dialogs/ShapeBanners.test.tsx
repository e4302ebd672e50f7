// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { api } from "../../../api/client";
import { ToastProvider } from "../../../components";
import type { TabRole } from "../../../drafts/editingRight";
import type { LeaseState } from "../../../drafts/leaseKeeper";
import { Observable } from "../../../drafts/observable";
import { draftIdentity, type KeptAside } from "../../../drafts/outbox";
import type { SaveState } from "../../../drafts/saveState";
import { FakeService, stroke } from "../../../drafts/testing";
import type { Desk } from "../desk/desk";
import type { HeldShape } from "../desk/heldShape";
import type { OpenShape } from "../shape/openShape";
import { ShapeBanners } from "./ShapeBanners";

const DRAFT = draftIdentity(new FakeService().record);
const CONFLICT: SaveState = {
  kind: "conflict",
  nQueued: 1,
  isKept: true,
  divergence: { common: 0, mine: [stroke(0, "mine")], theirs: [stroke(0, "theirs")] },
};
const REFUSED: SaveState = { kind: "refused", nQueued: 2, isKept: true, why: "no such part" };

let save: Observable<SaveState>;
let role: Observable<TabRole>;
let asides: KeptAside[];
const takeNamed = vi.fn();
let open: ReturnType<typeof opened>;

function opened() {
  const outbox = {
    asidesChanged: new Observable(0),
    asides: async () => asides,
    forgetAside: vi.fn(async () => {}),
  };
  return {
    draft: {
      right: { role, takeOver: vi.fn() },
      isConfirmedElsewhere: new Observable(false),
      sender: { state: save, outbox, draft: DRAFT, takeTheirs: vi.fn(), withdraw: vi.fn() },
    },
    labels: new Uint16Array(1),
    canEdit: true,
    isConfirming: new Observable(false),
    isBehind: new Observable(false),
    sidesOfConflict: async () => null,
    keepMine: vi.fn(() => new Promise<void>(() => {})),
    putOnTop: vi.fn(async () => {}),
  };
}

beforeEach(() => {
  save = new Observable<SaveState>({ kind: "saved" });
  role = new Observable<TabRole>("editing");
  asides = [];
  open = opened();
});
afterEach(() => {
  cleanup();
  vi.restoreAllMocks();
});

const aside = (some: Partial<KeptAside>): KeptAside => ({
  id: 1,
  draft: DRAFT,
  before: [],
  at: 0,
  reason: "closed",
  strokes: [stroke(0)],
  ...some,
});

function show(): void {
  const held = {
    keeper: { state: new Observable<LeaseState>({ kind: "held" }) },
    startTrouble: new Observable<string | null>(null),
  };
  render(
    <QueryClientProvider client={new QueryClient({ defaultOptions: { queries: { retry: false } } })}>
      <ToastProvider>
        <ShapeBanners
          desk={{ takeNamed } as unknown as Desk}
          held={held as unknown as HeldShape}
          open={open as unknown as OpenShape}
          isLossTold={false}
          onLeave={() => {}}
        />
      </ToastProvider>
    </QueryClientProvider>,
  );
}

const button = (name: string) => screen.getByRole("button", { name });

describe("two versions", () => {
  it("are settled once, however often the button is pressed", () => {
    save.set(CONFLICT);
    show();
    act(() => {
      button("Put mine on top").click();
      button("Put mine on top").click();
    });
    fireEvent.click(button("Take the saved one"));
    expect(open.keepMine).toHaveBeenCalledOnce();
    expect(open.draft.sender.takeTheirs).not.toHaveBeenCalled();
  });

  it("that could not be settled are told of, and can be tried again", async () => {
    save.set(CONFLICT);
    open.keepMine.mockRejectedValue(new Error("the labels do not fit"));
    show();
    fireEvent.click(button("Put mine on top"));
    await screen.findByText("the labels do not fit");
    fireEvent.click(button("Put mine on top"));
    expect(open.keepMine).toHaveBeenCalledTimes(2);
  });

  it.each([CONFLICT, REFUSED])("are nothing that a tab settles which only watches ($kind)", (state) => {
    save.set(state);
    role.set("watching");
    show();
    expect(screen.getAllByRole("button").map((each) => each.textContent)).toEqual(["Take over here"]);
  });
});

describe("strokes that were set aside", () => {
  it("of an earlier draft of the shape are put on top, and forgotten once they are", async () => {
    asides = [aside({ draft: { ...DRAFT, draftId: 1, key: "earlier" } })];
    show();
    fireEvent.click(await screen.findByRole("button", { name: "Put on top" }));
    await vi.waitFor(() => expect(open.draft.sender.outbox.forgetAside).toHaveBeenCalledWith(1));
    expect(open.putOnTop).toHaveBeenCalledWith(asides[0], null);
  });

  it("stay where they could not be put on top", async () => {
    asides = [aside({})];
    open.putOnTop.mockRejectedValue(new Error("the labels changed"));
    show();
    fireEvent.click(await screen.findByRole("button", { name: "Put on top" }));
    await screen.findByText("the labels changed");
    expect(open.draft.sender.outbox.forgetAside).not.toHaveBeenCalled();
  });

  function serveChairs(isOfAnotherWorkspace: (id: number) => boolean): void {
    vi.spyOn(api, "GET").mockImplementation((async (_path: string, { params }: never) => {
      const { shape_id: id } = (params as { path: { shape_id: number } }).path;
      const mesh = { mesh_hash: isOfAnotherWorkspace(id) ? "other" : "abc" };
      return { data: { id, source_key: `chair ${id}`, mesh } };
    }) as never);
  }

  it("of other shapes are told of, with the way there, if it is the same mesh", async () => {
    serveChairs((id) => id === 8);
    asides = [7, 8].map((shapeId) => aside({ id: shapeId, draft: { ...DRAFT, shapeId } }));
    asides.push(aside({ id: 9, draft: { ...DRAFT, shapeId: 9, personId: 99 } }));
    show();
    fireEvent.click(await screen.findByRole("button", { name: /^Open/ }));
    expect(takeNamed.mock.calls).toEqual([[7]]);
  });

  it("of many other shapes name four of the same mesh, whichever come first", async () => {
    serveChairs((id) => id < 15);
    asides = Array.from({ length: 10 }, (_, at) => aside({ id: at, draft: { ...DRAFT, shapeId: 11 + at } }));
    show();
    await screen.findByRole("button", { name: "Open chair 15" });
    const names = () => screen.getAllByRole("button", { name: /^Open/ }).map((each) => each.textContent);
    await vi.waitFor(() => expect(names()).toEqual([15, 16, 17, 18].map((id) => `Open chair ${id}`)));
  });
});
