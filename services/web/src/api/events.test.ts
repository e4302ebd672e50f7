// @vitest-environment jsdom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { type EventListener, listen } from "./events";

/** A stream that the test speaks through. */
class FakeSource extends EventTarget {
  static readonly CLOSED = 2;
  static opened: FakeSource[] = [];
  readyState = 1;

  constructor(readonly url: string) {
    super();
    FakeSource.opened.push(this);
  }

  close(): void {
    this.readyState = FakeSource.CLOSED;
  }

  tell(kind: string, lastEventId: string, data: unknown = ""): void {
    this.dispatchEvent(new MessageEvent(kind, { lastEventId, data: JSON.stringify(data) }));
  }

  static get last(): FakeSource {
    const last = FakeSource.opened.at(-1);
    if (!last) throw new Error("no stream was opened");
    return last;
  }
}

function look(state: DocumentVisibilityState): void {
  vi.spyOn(document, "visibilityState", "get").mockReturnValue(state);
  document.dispatchEvent(new Event("visibilitychange"));
}

let listener: { [Name in keyof EventListener]: ReturnType<typeof vi.fn> };
let stop: () => void;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("EventSource", FakeSource);
  FakeSource.opened = [];
  listener = { onEvent: vi.fn(), onMissed: vi.fn(), onConnection: vi.fn() };
  stop = listen(listener as unknown as EventListener);
});
afterEach(() => {
  stop();
  vi.useRealTimers();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});

describe("the stream of events", () => {
  it("hands events on", () => {
    FakeSource.last.tell("job", "5", { at: "now", collection_id: 3, payload: { job_id: 1 } });
    expect(listener.onEvent).toHaveBeenCalledWith({
      kind: "job",
      at: "now",
      collectionId: 3,
      payload: { job_id: 1 },
    });
  });

  it("says that it is there once it begins", () => {
    FakeSource.last.tell("begin", "5");
    expect(listener.onConnection).toHaveBeenCalledWith(true);
  });

  it("says when events were missed", () => {
    FakeSource.last.tell("missed", "9");
    expect(listener.onMissed).toHaveBeenCalledOnce();
  });

  it("is opened anew after the last id where the browser gives it up", () => {
    FakeSource.last.tell("begin", "5");
    FakeSource.last.close();
    FakeSource.last.dispatchEvent(new Event("error"));
    vi.advanceTimersByTime(4_000);
    expect(FakeSource.last.url).toBe("/api/v1/events?after=5");
  });

  it("is left to the browser where that resumes it", () => {
    FakeSource.last.dispatchEvent(new Event("error"));
    vi.advanceTimersByTime(60_000);
    expect(FakeSource.opened.length).toBe(1);
    expect(listener.onConnection).toHaveBeenCalledWith(false);
  });

  it("rests while nobody looks, and goes on from the last id", () => {
    FakeSource.last.tell("begin", "7");
    look("hidden");
    vi.advanceTimersByTime(30_000);
    expect(FakeSource.last.readyState).toBe(FakeSource.CLOSED);
    look("visible");
    expect(FakeSource.opened.map((each) => each.url)).toEqual(["/api/v1/events", "/api/v1/events?after=7"]);
  });

  it("does not rest because somebody looked away for a moment", () => {
    look("hidden");
    vi.advanceTimersByTime(10_000);
    look("visible");
    vi.advanceTimersByTime(60_000);
    expect(FakeSource.opened.length).toBe(1);
    expect(FakeSource.last.readyState).toBe(1);
  });
});
