/** What the service answers when something is wrong: RFC 9457, `type` being `urn:partwise:problem:<kind>`. */
export interface ProblemDocument {
  type: string;
  title: string;
  status: number;
  detail: string;
  [extension: string]: unknown;
}

const TYPE_PREFIX = "urn:partwise:problem:";

/** A refusal or fault of the service. `message` says what is wrong and what to do, in words for people. */
export class Problem extends Error {
  override readonly name = "Problem";

  constructor(readonly document: ProblemDocument) {
    super("fault_id" in document ? `${document.detail} (${document.fault_id})` : document.detail);
  }

  get status(): number {
    return this.document.status;
  }

  get kind(): string {
    return this.document.type.replace(TYPE_PREFIX, "");
  }
}

/** The service could not be reached: the network is down, or it is being restarted. */
export class Unreachable extends Error {
  override readonly name = "Unreachable";

  constructor(cause: unknown) {
    super(
      "The service cannot be reached. Try again when it is back; strokes are kept, and sent by themselves.",
      { cause },
    );
  }
}

/** The problem that an answer carries; one made from its status where it carries none, as from a proxy. */
export async function problemOf(response: Response): Promise<Problem> {
  const body: unknown = await response.json().catch(() => null);
  if (isProblemDocument(body)) return new Problem(body);
  return new Problem({
    type: "about:blank",
    title: response.statusText,
    status: response.status,
    detail: `The service answered ${response.status} ${response.statusText}. Try again in a moment.`,
  });
}

function isProblemDocument(body: unknown): body is ProblemDocument {
  return typeof body === "object" && body !== null && "detail" in body && "status" in body && "type" in body;
}
