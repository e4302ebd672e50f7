"""How long the annotator's tools take over HTTP: on a shape for the first time, again, and with another setting."""

import asyncio
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from partwise.errors import NotEnoughDataError, StoreError
from partwise.store.records import Collection, NewToken, Role
from partwise.workspace.segmentations import EVALUATE
from partwise.workspace.workspace import Workspace
from partwise_cli.bench.load_client import Answered, LoadClient
from partwise_cli.bench.load_server import HOST, served

PERSON = "bench"
_TOKEN_TTL = timedelta(hours=2)
_OK = 200
_N_WARM = 2
"""Shapes that are not counted: each of the tools' processes starts on one."""
_SETTINGS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "patches, random walks": ({"method": "random_walks", "n_patches": 20}, {"n_patches": 40}),
    "patches, k-means": ({"method": "k_means", "n_patches": 20}, {"n_patches": 40}),
    "refine model": ({}, {"smoothness": 2.0}),
    "refine boundaries": ({}, {"omega": 0.5}),
}
"""A tool's body, and what the other setting changes. The boundaries that are refined are the model's."""
_PATHS = {"patches": "patches", "refine model": "refine-model", "refine boundaries": "refine-boundaries"}


@dataclass(frozen=True, slots=True)
class ToolTiming:
    """A tool on one shape. ms, from sending to having read the answer: the first time, again, with another setting."""

    source_key: str
    tool: str
    n_faces: int
    first_ms: float
    again_ms: float
    other_ms: float

    @property
    def milliseconds(self) -> tuple[float, float, float]:
        """first, again, other."""
        return self.first_ms, self.again_ms, self.other_ms


def medians(timings: Sequence[ToolTiming]) -> list[ToolTiming]:
    """Of each tool, over its shapes."""
    found = []
    for tool in _SETTINGS:
        own = [each for each in timings if each.tool == tool]
        n_faces = int(np.median([each.n_faces for each in own]))
        found.append(
            ToolTiming("median", tool, n_faces, *np.median([each.milliseconds for each in own], axis=0).tolist())
        )
    return found


def time_service_tools(
    workspace: Workspace, collection: Collection, n_shapes: int, on_progress: Callable[[int, int], None]
) -> list[ToolTiming]:
    """Serves the workspace and asks for each tool on shapes that a model has seen, one call after another.

    Shapes before them take the starts of the tools' processes, which are not counted.

    Raises
    ------
    NotEnoughDataError : too few shapes have been evaluated. StoreError : the service fails.
    """
    shapes = workspace.catalog.shapes(collection.id, limit=20 * (n_shapes + _N_WARM))
    seen = workspace.catalog.stage_runs([shape.id for shape in shapes], EVALUATE)
    chosen = [(shape.id, shape.source_key) for shape in shapes if shape.id in seen][: n_shapes + _N_WARM]
    if len(chosen) <= _N_WARM:
        raise NotEnoughDataError(
            f"tools are timed on {_N_WARM + 1} shapes at least that a model has seen but {collection.name} has "
            f"{len(chosen)}; run `partwise evaluate`"
        )
    with tempfile.TemporaryDirectory(prefix="partwise-bench-") as folder, _secret(workspace) as secret:
        log = Path(folder) / "service.log"
        with served(workspace.path, log, ("--no-login",)) as server:
            return asyncio.run(_timed(LoadClient(HOST, server.port, secret), chosen, on_progress))


@contextmanager
def _secret(workspace: Workspace) -> Iterator[str]:
    """Of a token that ends with the block."""
    catalog = workspace.catalog
    known = {person.name: person.id for person in catalog.list_people()}
    person_id = known[PERSON] if PERSON in known else catalog.add_person(PERSON).id
    issued = catalog.issue_token(NewToken(person_id, Role.ANNOTATOR, datetime.now(UTC) + _TOKEN_TTL), PERSON)
    try:
        yield issued.secret
    finally:
        catalog.revoke_token(issued.token.id, PERSON)


async def _timed(
    client: LoadClient, chosen: list[tuple[int, str]], on_progress: Callable[[int, int], None]
) -> list[ToolTiming]:
    timings: list[ToolTiming] = []
    async with client:
        for place, (shape_id, source_key) in enumerate(chosen):
            answer = await _post(client, f"/shapes/{shape_id}/refine-model", {}, accept="application/json")
            labels = answer.json()
            # that call has prepared the model's cut: what it took is the first call's time
            for tool in _SETTINGS:
                first_ms = answer.ms if tool == "refine model" else None
                made = await _of_tool(client, tool, shape_id, source_key, labels, first_ms)
                timings += [made] if place >= _N_WARM else []
            on_progress(place + 1, len(chosen))
    return timings


async def _of_tool(
    client: LoadClient, tool: str, shape_id: int, source_key: str, labels: dict[str, Any], first_ms: float | None
) -> ToolTiming:
    body, change = _SETTINGS[tool]
    body, changed = (_within(each, labels["n_faces"]) for each in (body, {**body, **change}))
    if tool == "refine boundaries":
        body, changed = ({**each, "runs": labels["runs"]} for each in (body, changed))
    path = f"/shapes/{shape_id}/{_PATHS[tool.partition(',')[0]]}"
    if first_ms is None:
        first_ms = (await _post(client, path, body)).ms
    again, other = [(await _post(client, path, more)).ms for more in (body, changed)]
    return ToolTiming(source_key, tool, labels["n_faces"], first_ms, again, other)


def _within(body: dict[str, Any], n_faces: int) -> dict[str, Any]:
    """With no more patches than a small shape has faces."""
    return {**body, "n_patches": min(body["n_patches"], n_faces)} if "n_patches" in body else body


async def _post(client: LoadClient, path: str, body: dict[str, Any], accept: str = "*/*") -> Answered:
    answer = await client.post(path, body, {"Accept": accept})
    if answer.status != _OK:
        raise StoreError(f"{path} was answered with {answer.status}: {answer.body[:200].decode(errors='replace')}")
    return answer
