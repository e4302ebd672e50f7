"""The table of shapes under load: pages by every order and filter, one request after another."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from urllib.parse import urlencode

import numpy as np

from partwise.errors import StoreError
from partwise.store.records import BY_NAME, ListAnchor, ShapeState
from partwise.workspace.choices import ScoreName
from partwise.workspace.segmentations import DESCRIBE, REMESH
from partwise_cli.bench.load_client import Answered, LoadClient
from partwise_cli.bench.load_rows import N_CLUSTERS, N_PARTS
from partwise_cli.bench.load_workspace import LoadedWorkspace
from partwise_service.schemas.paging import cursor_of

PAGE = 100
_OK = 200
_RANKED_SHARE = 0.85  # of the shapes have scores, at least
Query = dict[str, str | int]
Draw = Callable[[np.random.Generator], Query]


@dataclass(frozen=True, slots=True)
class PageTimes:
    """Milliseconds of requests for one kind of page: by `order`, with `filter`, and `where` in the list."""

    order: str
    filter: str
    where: str
    ms: tuple[float, ...]


def filters(workspace: LoadedWorkspace) -> dict[str, Draw]:
    """Every filter, alone and in pairs that mean much, with values drawn for each request where there are many."""
    authors = [person.person_id for person in workspace.people]
    states = {f"state={state.value}": _fixed({"state": state.value}) for state in ShapeState}
    parts = {f"part={part}": _fixed({"part": part}) for part in range(1, N_PARTS + 1)}
    others: dict[str, Draw] = {
        "author=the first": _fixed({"author": authors[0]}),
        "author=any": lambda rng: {"author": int(rng.choice(authors))},
        "cluster=0": _fixed({"cluster": 0}),
        "cluster=any": lambda rng: {"cluster": int(rng.integers(N_CLUSTERS))},
        f"failure={REMESH}": _fixed({"failure": REMESH}),
        f"failure={DESCRIBE}": _fixed({"failure": DESCRIBE}),
        "cluster=any, state=ready": lambda rng: {"cluster": int(rng.integers(N_CLUSTERS)), "state": "ready"},
        "cluster=any, state=confirmed": lambda rng: {"cluster": int(rng.integers(N_CLUSTERS)), "state": "confirmed"},
        "cluster=0, part=1": _fixed({"cluster": 0, "part": 1}),
        "author=the first, part=2": _fixed({"author": authors[0], "part": 2}),
        "author=the first, state=ready": _fixed({"author": authors[0], "state": "ready"}),
        "state=confirmed, part=4": _fixed({"state": "confirmed", "part": 4}),
    }
    return {"none": _fixed({}), **states, **parts, **others}


def _fixed(query: Query) -> Draw:
    return lambda _: query


def orders() -> dict[str, Query]:
    """Every order and direction."""
    scores: dict[str, Query] = {name.value: {"order": name.value} for name in ScoreName}
    named: dict[str, Query] = {"id": {}, "name": {"order": BY_NAME}, **scores}
    return {
        f"{name} {'down' if descending else 'up'}": {**query, "direction": "desc" if descending else "asc"}
        for name, query in named.items()
        for descending in (False, True)
    }


@dataclass(frozen=True, slots=True)
class _Kind:
    """Pages of an order with a filter. where : "first", "middle" or "by rank"."""

    order: str
    of_order: Query
    filter: str
    draw: Draw
    where: str


async def time_pages(
    workspace: LoadedWorkspace, host: str, port: int, n_requests: int, seed: int, on_done: Callable[[int, int], None]
) -> list[PageTimes]:
    """First pages of every order with every filter; pages in the middle, and from a rank on, of every order."""
    rng = np.random.default_rng(seed)
    kinds, found = list(_kinds(workspace)), []
    async with LoadClient(host, port, workspace.people[0].secret) as client:
        pages = _Pages(client, f"/collections/{workspace.collection_id}/shapes", workspace.n_shapes, rng)
        for n_done, kind in enumerate(kinds, start=1):
            ms = [await pages.timed(kind) for _ in range(n_requests)]
            found.append(PageTimes(kind.order, kind.filter, kind.where, tuple(ms)))
            on_done(n_done, len(kinds))
    return found


def _kinds(workspace: LoadedWorkspace) -> Iterator[_Kind]:
    of_all = filters(workspace)
    for order, of_order in orders().items():
        for name, draw in of_all.items():
            yield _Kind(order, of_order, name, draw, "first")
        for name in ("none", "state=ready", "cluster=any"):
            yield _Kind(order, of_order, name, of_all[name], "middle")
        yield _Kind(order, of_order, "none", of_all["none"], "by rank")


@dataclass(frozen=True, slots=True)
class _Pages:
    client: LoadClient
    base: str
    n_shapes: int
    rng: np.random.Generator

    async def timed(self, kind: _Kind) -> float:
        """Milliseconds of one page."""
        query = {**kind.of_order, **kind.draw(self.rng), "limit": PAGE}
        rank = int(self.rng.random() * self.n_shapes * _RANKED_SHARE)
        if kind.where == "by rank":
            return (await self._answered("/ranked", {**query, "first_rank": rank})).ms
        if kind.where == "middle":
            found = (await self._answered("/ranked", {**kind.of_order, "first_rank": rank, "limit": 1})).json()["items"]
            query["after"] = cursor_of(ListAnchor(found[0]["id"], found[0]["score"]))
        return (await self._answered("", query)).ms

    async def _answered(self, path: str, query: Query) -> Answered:
        asked = f"{self.base}{path}?{urlencode(query)}"
        answer = await self.client.get(asked)
        if answer.status != _OK:
            raise StoreError(
                f"{asked} must be answered but: {answer.status} {answer.body[:300]!r}; see the service's log"
            )
        return answer
