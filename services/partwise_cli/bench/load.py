"""The service under load: the table of a very large catalog, and many people at work at once."""

import asyncio
import multiprocessing
import os
import tempfile
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from partwise.store.engine import connect_engine, parsed_url
from partwise_cli.bench.load_checks import LoadChecks, check_load
from partwise_cli.bench.load_people import PeoplePlan, work_of_people
from partwise_cli.bench.load_server import HOST, Database, Server, database, served
from partwise_cli.bench.load_table import PageTimes, time_pages
from partwise_cli.bench.load_workspace import LoadedWorkspace, make_workspace
from partwise_cli.bench.processes import core_s_of

OnStep = Callable[[str, int, int], None]
"""(what is being done, how much is done, of how much)"""
_CLAIMS_BEYOND = 2  # of a person, more than one each minute


@dataclass(frozen=True, slots=True)
class LoadRequest:
    """database : as in `load_server.database`. pages : requests for each kind of page; 0 for no table.

    minutes : for which people work; 0 for none. processes : that serve.
    """

    database: str = "sqlite"
    n_shapes: int = 300_000
    n_people: int = 200
    minutes: float = 3.0
    pages: int = 60
    seed: int = 0
    processes: int = 1


@dataclass(frozen=True, slots=True)
class Times:
    """Milliseconds of so many requests."""

    n: int
    p50_ms: float
    p99_ms: float
    max_ms: float


@dataclass(frozen=True, slots=True)
class PageReport:
    """Times of one kind of page, as `PageTimes`."""

    order: str
    filter: str
    where: str
    times: Times


@dataclass(frozen=True, slots=True)
class PeopleReport:
    """Times of every request, by what it was for; what went wrong; what the database's log says afterwards.

    late : how late requests were sent. requests_a_s : requests a second. core_ms : processor milliseconds for each, by
    whose: the service's, the database server's if it is ours, the people's. service_load : share of one core that the
    service took.
    """

    times: Mapping[str, Times]
    late: Times
    errors: list[str]
    checks: LoadChecks
    requests_a_s: float
    core_ms: Mapping[str, float]
    service_load: float


@dataclass(frozen=True, slots=True)
class LoadReport:
    """load_average : of the machine over the last minute, before and after: what else runs makes everything slower."""

    request: LoadRequest
    n_cpus: int
    load_average: tuple[float, float]
    pages: list[PageReport]
    people: PeopleReport | None

    @property
    def is_sound(self) -> bool:
        """Nothing failed, and the log afterwards is as it must be."""
        return self.people is None or (not self.people.errors and self.people.checks.is_sound)


def run_load(request: LoadRequest, on_step: OnStep) -> LoadReport:
    """Fills a workspace in a temporary folder, serves it on loopback, and puts the load on it."""
    before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory(prefix="partwise-load-") as name, database(request.database, Path(name)) as stored:
        folder = Path(name)
        on_step("fill the catalog", 0, 1)
        n_own = round(request.n_people * (request.minutes + _CLAIMS_BEYOND)) if request.minutes else 0
        workspace = make_workspace(folder / "ws", stored.url, request.n_shapes, request.n_people, n_own, request.seed)
        on_step("fill the catalog", 1, 1)
        options = ("--processes", str(request.processes))
        with served(workspace.path, folder / "service.log", options) as server:
            pages = _pages(request, workspace, server, on_step) if request.pages else []
            people = _people(request, workspace, server, stored, on_step) if request.minutes else None
    return LoadReport(request, os.cpu_count() or 1, (before, os.getloadavg()[0]), pages, people)


def times_of(ms: "list[float] | tuple[float, ...]") -> Times:
    """The usual figures of some times."""
    if not ms:
        return Times(0, 0.0, 0.0, 0.0)
    p50, p99 = np.percentile(ms, [50, 99], method="higher")
    return Times(len(ms), round(float(p50), 2), round(float(p99), 2), round(max(ms), 2))


def _pages(request: LoadRequest, workspace: LoadedWorkspace, server: Server, on_step: OnStep) -> list[PageReport]:
    def note(n_done: int, n_total: int) -> None:
        on_step("pages of the table", n_done, n_total)

    found: list[PageTimes] = asyncio.run(time_pages(workspace, HOST, server.port, request.pages, request.seed, note))
    return [PageReport(each.order, each.filter, each.where, times_of(each.ms)) for each in found]


def _people(
    request: LoadRequest, workspace: LoadedWorkspace, server: Server, stored: Database, on_step: OnStep
) -> PeopleReport:
    plan = PeoplePlan(workspace, HOST, server.port, request.minutes, request.seed)
    pids = {"service": server.pid} | ({} if stored.pid is None else {"database": stored.pid})
    on_step("people at work", 0, 1)
    before = {whose: core_s_of(pid) for whose, pid in pids.items()}
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as client:
        log = client.submit(work_of_people, plan).result()
    spent_s = {whose: core_s_of(pid) - before[whose] for whose, pid in pids.items()} | {"people": log.core_s}
    on_step("people at work", 1, 1)
    engine = connect_engine(parsed_url(workspace.database_url))
    try:
        checks = check_load(engine, workspace.collection_id, log.holds, log.acknowledged)
    finally:
        engine.dispose()
    n_requests = sum(map(len, log.ms.values()))
    return PeopleReport(
        {what: times_of(ms) for what, ms in sorted(log.ms.items())},
        times_of(log.late_ms),
        log.errors,
        checks,
        round(n_requests / log.wall_s, 1),
        {whose: round(1000 * spent / max(1, n_requests), 2) for whose, spent in spent_s.items()},
        round(spent_s["service"] / log.wall_s, 3),
    )
