"""The pieces of `partwise bench load` at a size that takes seconds."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import Engine, insert

from partwise.store import tables as t
from partwise.store.engine import connect_engine, parsed_url, writing
from partwise.store.records import ShapeFilter, ShapeOrder, ShapeState
from partwise.store.tables.listing import FACETS
from partwise.workspace.workspace import open_workspace
from partwise_cli.bench.load import LoadReport, LoadRequest, run_load, times_of
from partwise_cli.bench.load_checks import check_load
from partwise_cli.bench.load_people import CLAIM, MESH, OPEN, Hold
from partwise_cli.bench.load_report import print_load
from partwise_cli.bench.load_workspace import LoadedWorkspace, make_workspace

N_SHAPES, N_PEOPLE, N_OWN = 400, 3, 5
AT = datetime(2026, 1, 1, tzinfo=UTC)


@pytest.fixture(scope="module")
def loaded(tmp_path_factory) -> LoadedWorkspace:
    folder = tmp_path_factory.mktemp("load")
    return make_workspace(folder / "ws", f"sqlite:///{folder}/ws/catalog.sqlite", N_SHAPES, N_PEOPLE, N_OWN, 0)


@pytest.fixture
def engine(loaded) -> Iterator[Engine]:
    """Of a catalog without leases and strokes before and after."""
    made = connect_engine(parsed_url(loaded.database_url))
    yield made
    with writing(made) as connection:
        connection.execute(t.lease.delete())
    made.dispose()


def _lease(engine: Engine, loaded: LoadedWorkspace, person: int, shape: int, since_s: float, until_s: float) -> None:
    row = {
        "collection_id": loaded.collection_id, "shape_id": shape, "slot": 0, "round": 1, "purpose": "label",
        "person_id": loaded.people[person].person_id, "is_prefetched": False, "outcome": "completed",
        "acquired_at": AT + timedelta(seconds=since_s), "released_at": AT + timedelta(seconds=until_s),
        "expires_at": AT + timedelta(seconds=until_s),
    }  # fmt: skip
    with writing(engine) as connection:
        connection.execute(insert(t.lease).values(row))


def test_rows_are_as_the_catalog_would_have_derived_them(loaded) -> None:
    with open_workspace(loaded.path) as workspace:
        listed = workspace.catalog.list_shapes(loaded.collection_id, limit=N_SHAPES + 1)
        derived = workspace.catalog.shape_states([row.shape.id for row in listed])
    assert {row.state for row in listed} == set(ShapeState)
    assert {row.shape.id: row.state for row in listed} == dict(derived)


def test_facets_stand_beside_scores(loaded) -> None:
    made = connect_engine(parsed_url(loaded.database_url))
    with made.connect() as connection:
        joined = t.score.join(t.shape_facet, t.shape_facet.c.shape_id == t.score.c.shape_id)
        differs = [t.score.c[name].is_distinct_from(t.shape_facet.c[name]) for name in FACETS]
        rows = connection.execute(t.score.select().select_from(joined).add_columns(*differs)).all()
    made.dispose()
    assert rows
    assert not any(any(row[-len(FACETS) :]) for row in rows)


def test_what_is_claimed_first_has_a_mesh_of_its_own(loaded) -> None:
    with open_workspace(loaded.path) as workspace:
        order = ShapeOrder("entropy", descending=True)
        first = workspace.catalog.list_shapes(
            loaded.collection_id, where=ShapeFilter(state=ShapeState.READY), order=order, limit=N_OWN + 1
        )
    hashes = [row.shape.mesh_hash for row in first]
    assert len(set(hashes[:N_OWN])) == N_OWN
    assert hashes[N_OWN] not in hashes[:N_OWN]


def test_leases_after_each_other_are_sound(loaded, engine) -> None:
    _lease(engine, loaded, 0, 7, 0, 10)
    _lease(engine, loaded, 1, 7, 10, 20)
    checks = check_load(engine, loaded.collection_id, [], {})
    assert (checks.is_sound, checks.n_leases) == (True, 2)


def test_a_slot_that_two_hold_is_found(loaded, engine) -> None:
    _lease(engine, loaded, 0, 7, 0, 10)
    _lease(engine, loaded, 1, 7, 9, 20)
    checks = check_load(engine, loaded.collection_id, [], {})
    assert checks.slots_leased_twice == ["shape 7, slot 0"]
    assert not checks.is_sound


def test_a_shape_that_one_person_gets_twice_is_found(loaded, engine) -> None:
    _lease(engine, loaded, 0, 7, 0, 10)
    _lease(engine, loaded, 0, 7, 10, 20)
    checks = check_load(engine, loaded.collection_id, [], {})
    assert checks.given_to_one_person_twice == [f"person {loaded.people[0].person_id}, shape 7: 2 times"]


def test_what_two_people_saw_at_once_is_found(loaded, engine) -> None:
    holds = [Hold(1, 7, 0.0, 5.0), Hold(2, 7, 4.0, 6.0), Hold(2, 8, 0.0, 5.0)]
    assert check_load(engine, loaded.collection_id, holds, {}).seen_by_two_people == ["shape 7"]


def test_an_acknowledged_stroke_that_is_not_there_is_found(loaded, engine) -> None:
    lost = check_load(engine, loaded.collection_id, [], {3: ["a stroke"]}).strokes_lost_or_twice
    assert lost == ["draft 3: 1 acknowledged, 0 there"]


def test_percentiles_are_times_that_were_had() -> None:
    times = times_of([float(ms) for ms in range(1, 101)])
    assert (times.n, times.p50_ms, times.p99_ms, times.max_ms) == (100, 51.0, 100.0, 100.0)


@pytest.fixture(scope="module")
def report() -> LoadReport:
    """Of a run through a real service, in which each has just claimed when the time is over."""
    return run_load(LoadRequest(n_shapes=N_SHAPES, n_people=N_PEOPLE, minutes=1e-6, pages=0), lambda *_: None)


@pytest.mark.slow
def test_a_run_against_a_service_is_sound(report, capsys) -> None:
    assert report.is_sound
    assert report.people.checks.n_leases == N_PEOPLE
    assert {what: times.n for what, times in report.people.times.items()} == dict.fromkeys(
        (CLAIM, OPEN, MESH), N_PEOPLE
    )
    print_load(report)
    assert "0 errors" in capsys.readouterr().out


@pytest.mark.slow
def test_several_processes_serve_the_people() -> None:
    request = LoadRequest(n_shapes=N_SHAPES, n_people=N_PEOPLE, minutes=1e-6, pages=0, processes=2)
    report = run_load(request, lambda *_: None)
    assert report.is_sound
    assert set(report.people.core_ms) == {"service", "people"}
    assert all(ms > 0 for ms in report.people.core_ms.values())
