"""Where a collection stands."""

from partwise.store.records import NewFailure, ShapeState
from partwise.workspace.status import FailedShape, StageStatus, collection_status


def test_an_empty_collection_has_every_state_at_nought(workspace, collection) -> None:
    status = collection_status(workspace, collection, max_failures=5)
    assert dict(status.states) == dict.fromkeys(ShapeState, 0)
    assert (status.stages, status.model_version, status.failures) == ((), None, ())


def test_stages_come_in_the_order_in_which_they_run(filled) -> None:
    filled.refined(filled.described().evaluated())
    status = collection_status(filled.workspace, filled.collection, max_failures=5)
    assert status.stages == tuple(StageStatus(name, 3, 0) for name in ("mesh", "describe", "evaluate", "refine"))
    assert status.model_version == 1


def test_an_unknown_stage_comes_last(filled) -> None:
    filled.described()
    filled.workspace.catalog.record_failure(NewFailure(filled.ids["a.off"], "audit", "k", "because"))
    stages = collection_status(filled.workspace, filled.collection, max_failures=5).stages
    assert [stage.stage for stage in stages] == ["mesh", "describe", "audit"]


def test_failures_come_with_their_reasons(filled) -> None:
    for key in ("a.off", "b.off"):
        filled.workspace.catalog.record_failure(NewFailure(filled.ids[key], "mesh", "k", f"{key} is too flat"))
    status = collection_status(filled.workspace, filled.collection, max_failures=1)
    assert dict(status.states)["failed"] == 2
    assert status.stages == (StageStatus("mesh", 0, 2),)
    assert status.failures == (FailedShape("a.off", "mesh", "a.off is too flat"),)
