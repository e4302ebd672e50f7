"""A worker says that it is there, and what it takes of its machine."""

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

from partwise.store.records import JobKind, SeenWorker
from partwise_cli.jobs.presence import Presence
from partwise_cli.jobs.work import Outcome, Work
from partwise_workers.events import ActorMemory, InFlight


def _seen(workspace) -> Sequence[SeenWorker]:
    return workspace.catalog.workers(datetime.now(UTC) - timedelta(minutes=1))


def test_it_takes_memory_and_has_room_on_its_disk(workspace) -> None:
    usage = Presence(workspace.catalog, "w1", workspace.array_url, timedelta(minutes=1)).usage()
    assert usage.memory_bytes > 10**7
    assert usage.free_bytes is not None
    assert (usage.n_actors, usage.actor_bytes) == (0, 0)


def test_what_its_actors_take_is_what_they_told_last(workspace) -> None:
    presence = Presence(workspace.catalog, "w1", workspace.array_url, timedelta(minutes=1))
    for event in (ActorMemory(2, 500), ActorMemory(1, 300), InFlight(4)):
        presence.on_event(event)
    assert (presence.usage().n_actors, presence.usage().actor_bytes) == (1, 300)


def test_a_store_that_is_no_folder_has_no_disk(workspace) -> None:
    assert Presence(workspace.catalog, "w1", "s3://bucket/arrays", timedelta(minutes=1)).usage().free_bytes is None


def test_a_worker_is_there_while_it_works_and_no_longer(workspace, enqueue, worker) -> None:
    found: list[SeenWorker] = []

    def look(work: Work) -> Outcome:
        while not found:
            found.extend(_seen(workspace))
        return Outcome("done")

    enqueue(JobKind.EXPORT)
    worker({JobKind.EXPORT: look}, owner="w1").run(once=True)
    assert [each.owner for each in found] == ["w1"]
    assert _seen(workspace) == []
