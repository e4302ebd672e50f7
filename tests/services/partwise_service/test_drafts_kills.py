"""The service killed at random moments while people draw and confirm: what was acknowledged is on record, once."""

import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from uuid import UUID

import httpx
import numpy as np
import pytest

from partwise.store.records import NewToken, Role
from partwise.workspace.workspace import open_workspace

N_KILLS = 12
N_PEOPLE = 3
MAX_BATCH, MAX_BATCHES = 4, 6
SEED = 20_261_122
START_S = 120.0
_SERVE = """
import sys
from pathlib import Path
import uvicorn
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings
uvicorn.run(create_app(ServiceSettings(workspace=Path(sys.argv[1]))), fd=int(sys.argv[2]), log_level="error")
"""


class Server:
    """The service as a process on a socket that outlives it, so that clients find the next one at the same address."""

    def __init__(self, path) -> None:
        self._path = path
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._socket.getsockname()[1]}/api/v1"
        self._process: subprocess.Popen | None = None

    def start(self) -> None:
        fd = self._socket.fileno()
        command = [sys.executable, "-c", _SERVE, str(self._path), str(fd)]
        self._process = subprocess.Popen(command, pass_fds=[fd])

    def kill(self) -> None:
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()

    def close(self) -> None:
        if self._process is not None:
            self.kill()
        self._socket.close()


@dataclass
class Progress:
    """How many sendings were acknowledged, by all together."""

    n_acknowledged: int = 0
    changed: threading.Condition = field(default_factory=threading.Condition)
    is_over: bool = False

    def note(self) -> None:
        with self.changed:
            self.n_acknowledged += 1
            self.changed.notify_all()

    def wait_for_more(self, n: int) -> None:
        with self.changed:
            wanted = self.n_acknowledged + n
            assert self.changed.wait_for(lambda: self.n_acknowledged >= wanted, START_S), "the service is stuck"


@dataclass
class DraftOf:
    """A draft as its person knows it: strokes that were acknowledged, and the checksum of labels, once confirmed."""

    draft_id: int
    base_revision: int | None
    strokes: list[str] = field(default_factory=list)
    labels_sha256: str | None = None


class Person(threading.Thread):
    """Draws on a shape and confirms, again and again, sending everything until it is acknowledged."""

    def __init__(self, url: str, secret: str, person_id: int, mugs, shape_id: int, progress: Progress, seed) -> None:
        super().__init__(daemon=True)
        self._client = httpx.Client(base_url=url, headers={"Authorization": f"Bearer {secret}"}, timeout=START_S)
        self._person_id, self._mugs, self._shape_id = person_id, mugs, shape_id
        self._progress, self._rng = progress, np.random.default_rng(seed)
        self.drafts: list[DraftOf] = []
        self.n_repeated = 0
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            while not self._progress.is_over:
                self._draw_and_confirm()
        except BaseException as error:
            self.failure = error
            raise

    def _draw_and_confirm(self) -> None:
        drawn = self._begun()
        for _ in range(int(self._rng.integers(1, MAX_BATCHES + 1))):
            first = len(drawn.strokes)
            strokes = [self._stroke(drawn, first + n) for n in range(int(self._rng.integers(1, MAX_BATCH + 1)))]
            self._post(f"/drafts/{drawn.draft_id}/strokes", {"expected_sequence": first, "strokes": strokes})
            drawn.strokes.extend(stroke["id"] for stroke in strokes)
            self._progress.note()
        tag = {"If-Match": f'"{len(drawn.strokes)}"'}
        drawn.labels_sha256 = self._post(f"/drafts/{drawn.draft_id}/confirm", {}, tag)["labels_sha256"]
        self._progress.note()

    def _begun(self) -> DraftOf:
        """A new draft from the labels that were confirmed last."""
        leases = self._get("/leases")["items"]
        if not leases:
            wish = {"collection_id": self._mugs.collection_id, "shape_ids": [self._shape_id]}
            self._post("/queue/claim", wish, may_conflict=True)  # 409 : held since a claim whose answer was lost
            leases = self._get("/leases")["items"]
        revisions = self._get(f"/shapes/{self._shape_id}/revisions")["items"]
        base = max((revision["id"] for revision in revisions), default=None)
        draft = self._post(f"/leases/{leases[0]['id']}/draft", {"base_revision": base})
        self.drafts.append(DraftOf(draft["id"], draft["base_revision"]))
        return self.drafts[-1]

    def _get(self, path: str) -> dict:
        return self._until_answered("GET", path, {}).json()

    def _post(self, path: str, body: dict, headers: dict | None = None, may_conflict: bool = False) -> dict:
        answer = self._until_answered("POST", path, {"json": body, "headers": headers})
        if may_conflict and answer.status_code == 409:
            return {}
        assert answer.is_success, answer.text
        return answer.json()

    def _until_answered(self, method: str, path: str, given: dict) -> httpx.Response:
        while True:
            try:
                return self._client.request(method, path, **given)
            except httpx.TransportError:
                self.n_repeated += 1

    def _stroke(self, drawn: DraftOf, sequence: int) -> dict:
        return {
            "v": 1,
            "kind": "assign",
            "runs": [[0, 1]],
            "label": int(self._rng.integers(1, 3)),
            "id": str(UUID(bytes=self._rng.bytes(16), version=4)),
            "sequence": sequence,
            "base_revision": drawn.base_revision,
            "author_id": self._person_id,
            "at": "2026-11-22T12:00:00Z",
        }


@pytest.fixture
def server(mugs) -> Iterator[Server]:
    made = Server(mugs.path)
    yield made
    made.close()


def _people(server: Server, mugs, progress: Progress) -> list[Person]:
    seeds = np.random.SeedSequence(SEED).spawn(N_PEOPLE)
    people = []
    with open_workspace(mugs.path) as workspace:
        for n, shape_id in enumerate(list(mugs.ids.values())[:N_PEOPLE]):
            person = workspace.catalog.add_person(f"person {n}")
            new = NewToken(person.id, Role.ANNOTATOR, datetime.now(UTC) + timedelta(days=1))
            secret = workspace.catalog.issue_token(new, "test").secret
            people.append(Person(server.url, secret, person.id, mugs, shape_id, progress, seeds[n]))
    return people


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_what_was_acknowledged_is_there_once_whenever_the_service_is_killed(server, mugs) -> None:
    rng, progress = np.random.default_rng(SEED), Progress()
    people = _people(server, mugs, progress)
    server.start()
    for person in people:
        person.start()
    for _ in range(N_KILLS):
        progress.wait_for_more(int(rng.integers(1, 40)))
        with progress.changed:  # some moment after an acknowledgement, while others' strokes are on their way
            progress.changed.wait(float(rng.random()) * 0.02)
        server.kill()
        server.start()
    progress.wait_for_more(N_PEOPLE)
    progress.is_over = True
    for person in people:
        person.join(START_S)
        assert not person.is_alive()
        assert person.failure is None
    with open_workspace(mugs.path) as workspace:
        for person in people:
            for drawn in person.drafts:
                _check_draft(workspace, drawn)
            _check_revisions(workspace, person)
    assert sum(person.n_repeated for person in people) >= N_KILLS  # the kills did meet requests on their way
    assert sum(len(person.drafts) for person in people) > N_KILLS


def _check_draft(workspace, drawn: DraftOf) -> None:
    recorded = workspace.catalog.strokes(drawn.draft_id)
    assert [stroke.id for stroke in recorded] == drawn.strokes
    assert [stroke.sequence for stroke in recorded] == list(range(len(recorded)))
    assert workspace.catalog.draft(drawn.draft_id).n_strokes == len(recorded)


def _check_revisions(workspace, person: Person) -> None:
    """Each confirmation has made one revision, on top of the one before it, and there is no other."""
    revisions = sorted(workspace.catalog.revisions(person._shape_id), key=lambda revision: revision.id)
    assert len({drawn.draft_id for drawn in person.drafts}) == len(person.drafts)
    assert [revision.sha256 for revision in revisions] == [drawn.labels_sha256 for drawn in person.drafts]
    assert [revision.id for revision in revisions[:-1]] == [drawn.base_revision for drawn in person.drafts[1:]]
