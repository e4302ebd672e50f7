"""People at work, all at once: each claims, loads, draws, looks what it holds, confirms, and goes on with the next."""

import asyncio
import time
from collections import defaultdict
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from uuid import UUID

import numpy as np

from partwise.errors import PartwiseError
from partwise_cli.bench.load_client import Answered, LoadClient
from partwise_cli.bench.load_rows import N_PARTS
from partwise_cli.bench.load_workspace import LoadedWorkspace, Person

POLL_S, STROKE_S, CONFIRM_S = 5.0, 2.0, 60.0
_POLLS_A_HEARTBEAT = 12  # a minute of five that a lease lasts
_OK = 200
CLAIM, OPEN, MESH, STROKE, POLL, HEARTBEAT, CONFIRM = (
    "claim",
    "open draft",
    "mesh",
    "stroke",
    "poll",
    "heartbeat",
    "confirm",
)


@dataclass(frozen=True, slots=True)
class PeoplePlan:
    """Load for `minutes`, after each person began at a moment of its own within the first of `CONFIRM_S` seconds.

    paces : seconds between polls, strokes and confirmations of a person.
    """

    workspace: LoadedWorkspace
    host: str
    port: int
    minutes: float
    seed: int
    paces: tuple[float, float, float] = (POLL_S, STROKE_S, CONFIRM_S)


@dataclass(frozen=True, slots=True)
class Hold:
    """A shape in a person's hands, in seconds of the client's clock: as the people themselves saw it."""

    person_id: int
    shape_id: int
    since_s: float
    until_s: float


@dataclass(frozen=True, slots=True)
class PeopleLog:
    """What the people saw.

    ms : milliseconds of every request, by what it was for. late_ms : how late requests were sent, as an answer before
    was waited for or the client was busy. errors : answers that were no success, and connections that broke.
    acknowledged : ids of strokes in order, by draft. wall_s : from the first request to the last answer.
    core_s : processor seconds that being the people took.
    """

    ms: dict[str, list[float]]
    late_ms: list[float]
    errors: list[str]
    acknowledged: dict[int, list[str]]
    holds: list[Hold]
    wall_s: float
    core_s: float


def work_of_people(plan: PeoplePlan) -> PeopleLog:
    """Runs the plan: to be called in a process of its own."""
    return asyncio.run(_all_at_work(plan))


async def _all_at_work(plan: PeoplePlan) -> PeopleLog:
    log = PeopleLog(defaultdict(list), [], [], {}, [], 0.0, 0.0)
    seeds = np.random.SeedSequence(plan.seed).spawn(len(plan.workspace.people))
    started, spent_s = time.perf_counter(), time.process_time()
    until = started + 60 * plan.minutes
    await asyncio.gather(
        *(
            _Worker(plan, person, np.random.default_rng(seed), log, until).run()
            for person, seed in zip(plan.workspace.people, seeds, strict=True)
        )
    )
    return replace(log, ms=dict(log.ms), wall_s=time.perf_counter() - started, core_s=time.process_time() - spent_s)


class _StopError(Exception):
    """This person cannot go on; why is on the log."""


@dataclass(slots=True)
class _Worker:
    plan: PeoplePlan
    person: Person
    rng: np.random.Generator
    log: PeopleLog
    until: float
    held: tuple[int, int, float] = (0, 0, 0.0)  # lease, shape, since
    draft_id: int = 0
    n_strokes: int = 0
    n_polls: int = 0
    due: dict[str, float] = field(default_factory=dict)

    async def run(self) -> None:
        poll_s, stroke_s, confirm_s = self.plan.paces
        await asyncio.sleep(float(self.rng.random()) * confirm_s)
        try:
            async with LoadClient(self.plan.host, self.plan.port, self.person.secret) as client:
                await self._claim(client)
                now = time.perf_counter()
                self.due = {
                    POLL: now + float(self.rng.random()) * poll_s,
                    STROKE: now + float(self.rng.random()) * stroke_s,
                    CONFIRM: now + confirm_s,
                }
                await self._draw(client, dict(zip((POLL, STROKE, CONFIRM), self.plan.paces, strict=True)))
        except _StopError:
            pass
        except (PartwiseError, OSError) as error:
            self.log.errors.append(str(error))
        self._note_hold()

    async def _draw(self, client: LoadClient, paces: dict[str, float]) -> None:
        acts = {POLL: self._poll, STROKE: self._stroke, CONFIRM: self._confirm}
        while True:
            what = min(self.due, key=self.due.__getitem__)
            at = self.due[what]
            if at > self.until:
                return
            await asyncio.sleep(max(0.0, at - time.perf_counter()))
            self.log.late_ms.append(1000 * (time.perf_counter() - at))
            self.due[what] = at + paces[what]
            await acts[what](client)

    async def _claim(self, client: LoadClient) -> None:
        claimed = await client.post("/queue/claim", {"collection_id": self.plan.workspace.collection_id})
        items = self._noted(CLAIM, claimed).json()["items"]
        if not items:
            self.log.errors.append("claim: the queue is empty")
            raise _StopError
        lease = items[0]
        self.held = (lease["id"], lease["shape_id"], time.perf_counter())
        opened = self._noted(OPEN, await client.post(f"/leases/{lease['id']}/draft", {})).json()
        self.draft_id, self.n_strokes = opened["id"], opened["n_strokes"]
        self.log.acknowledged.setdefault(self.draft_id, [])
        self._noted(MESH, await client.get(f"/meshes/{lease['mesh_hash']}?shape_id={lease['shape_id']}"))

    async def _stroke(self, client: LoadClient) -> None:
        stroke = self._some_stroke()
        body = {"expected_sequence": self.n_strokes, "strokes": [stroke]}
        self._noted(STROKE, await client.post(f"/drafts/{self.draft_id}/strokes", body))
        self.log.acknowledged[self.draft_id].append(str(stroke["id"]))
        self.n_strokes += 1

    async def _poll(self, client: LoadClient) -> None:
        self.n_polls += 1
        if self.n_polls % _POLLS_A_HEARTBEAT == 0:
            self._noted(HEARTBEAT, await client.post(f"/leases/{self.held[0]}/heartbeat", {}))
        else:
            self._noted(POLL, await client.get("/leases"))

    async def _confirm(self, client: LoadClient) -> None:
        seen = {"If-Match": f'"{self.n_strokes}"'}
        self._noted(CONFIRM, await client.post(f"/drafts/{self.draft_id}/confirm", {}, seen))
        self._note_hold()
        await self._claim(client)

    def _note_hold(self) -> None:
        _, shape_id, since = self.held
        if shape_id:
            self.log.holds.append(Hold(self.person.person_id, shape_id, since, time.perf_counter()))
            self.held = (0, 0, 0.0)

    def _noted(self, what: str, answer: Answered) -> Answered:
        if answer.status != _OK:
            self.log.errors.append(f"{what}: {answer.status} {answer.body[:300].decode(errors='replace')}")
            raise _StopError
        self.log.ms[what].append(answer.ms)
        return answer

    def _some_stroke(self) -> dict[str, object]:
        """A few runs of faces that become one part: what dragging across patches sends."""
        n_runs = int(self.rng.integers(1, 9))
        ends = np.sort(self.rng.choice(self.plan.workspace.n_faces, 2 * n_runs, replace=False)).reshape(-1, 2)
        return {
            "v": 1,
            "kind": "assign",
            "runs": [[int(start), int(end - start)] for start, end in ends],
            "label": int(self.rng.integers(1, N_PARTS + 1)),
            "id": str(UUID(bytes=self.rng.bytes(16), version=4)),
            "sequence": self.n_strokes,
            "base_revision": None,
            "author_id": self.person.person_id,
            "at": datetime.now(UTC).isoformat().replace("+00:00", "Z"),
        }
