"""How a collection is doing: for operators."""

from datetime import timedelta

import numpy as np
import pytest

from partwise.labels.annotation_cost import AnnotationCost
from partwise.store.records import (
    Closeness,
    JobKind,
    NewBlindCheck,
    NewClaim,
    NewConfirmation,
    NewFailure,
    NewRevision,
    NewShape,
    Progress,
    RevisionKind,
    Role,
    WorkerUsage,
)
from partwise.testing.workspaces import publish_evaluation, save_model
from partwise.workspace.confirming import begin_draft
from partwise_service.routes import operations


@pytest.fixture
def ops(operator, mugs):
    """The figures as they are told."""
    return lambda: operator.get(f"/collections/{mugs.collection_id}/ops").json()


@pytest.fixture
def confirmed(annotator, workspace, mugs):
    """ann labels the next shape, which took her so long: `confirmed(20.0)`; by its draw, unknowing or not."""
    catalog = workspace.catalog
    ann = catalog.get_person("ann").id

    def done(active_s: float, draw: float = 0.9, check: NewBlindCheck | None = None) -> int:
        lease = catalog.claim_next(NewClaim(mugs.collection_id, ann, 60, draw))
        draft = begin_draft(workspace, lease, lease.person_id)
        n_faces = catalog.mesh(draft.shape_id, draft.mesh_hash).n_faces
        cost = AnnotationCost(strokes=6, commands=0, undos=0, redos=0, active_s=active_s, n_idle_gaps=0)
        labels = np.ones(n_faces, dtype=np.uint16)
        catalog.confirm_draft(NewConfirmation(draft.id, ann, 0, labels, 1, blind_check=check, cost=cost))
        return lease.shape_id

    return done


@pytest.fixture
def reference_id(workspace, mugs) -> int:
    """Truth of a.off; every claim by a low draw gets it."""
    catalog, mesh = workspace.catalog, mugs.meshes["a.off"]
    catalog.update_collection_settings(mugs.collection_id, {"honeypot_share": 0.5})
    truth, labels = catalog.add_person("truth").id, np.ones(mesh.n_faces, dtype=np.uint16)
    new = NewRevision(mugs.ids["a.off"], mesh.content_hash(), RevisionKind.REFERENCE, truth, 1, labels)
    return catalog.add_revision(new).id


def test_states_and_failures(workspace, mugs, ops) -> None:
    failure = NewFailure(mugs.ids["a.off"], "remesh", "k9", "too large", detail={"kind": "memory"})
    workspace.catalog.record_failure(failure)
    shown = ops()
    assert shown["states"]["ready"] == 3
    assert (shown["failures"]["memory"], shown["model_version"], shown["open_reviews"]) == (1, 1, 0)


def test_stages_say_how_long_they_take_yet(workspace, mugs, ops, monkeypatch) -> None:
    monkeypatch.setattr(operations, "WINDOW", timedelta(days=1))  # the shapes were made when the tests began
    per_min = 3 / (24 * 60)
    workspace.catalog.record_failure(NewFailure(mugs.ids["a.off"], "remesh", "k9", "why"))
    workspace.catalog.supersede_block(
        workspace.catalog.stage_runs([mugs.ids["a.off"]], "refine")[mugs.ids["a.off"]].block_name
    )
    stages = {stage["stage"]: stage for stage in ops()["stages"]}
    assert list(stages) == ["mesh", "remesh", "describe", "evaluate", "refine"]
    done = {"stage": "mesh", "done": 3, "failed": 0, "remaining": 0, "per_min": pytest.approx(per_min), "eta_s": 0}
    assert stages["mesh"] == done
    assert (stages["remesh"]["remaining"], stages["remesh"]["eta_s"]) == (2, None)
    assert (stages["refine"]["done"], stages["refine"]["remaining"]) == (0, 3)
    assert stages["refine"]["eta_s"] == pytest.approx(3 / per_min * 60)


def test_what_a_stage_gave_up_waits_for_none_after_it(workspace, mugs, ops) -> None:
    new = [NewShape("broken.off", "0" * 64, ".off"), NewShape("waits.off", "1" * 64, ".off")]
    broken, _ = workspace.catalog.add_shapes(mugs.collection_id, new)
    workspace.catalog.record_failure(NewFailure(broken.shape_id, "mesh", "k9", "why"))
    waiting = {stage["stage"]: stage["remaining"] for stage in ops()["stages"]}
    assert waiting == {"mesh": 1, "describe": 1, "evaluate": 0, "refine": 0}


def test_what_an_older_model_predicted_waits_for_the_newest(workspace, mugs, clock, ops) -> None:
    second = save_model(workspace, workspace.catalog.get_collection("mugs"))
    assert [_counts(ops(), stage) for stage in ("evaluate", "refine")] == [(0, 3), (0, 3)]
    probabilities = {mugs.ids["a.off"]: np.tile([0.5, 0.5], (mugs.meshes["a.off"].n_faces, 1))}
    publish_evaluation(workspace, second, (1, 2), probabilities)
    clock.now_s += 60
    assert [_counts(ops(), stage) for stage in ("evaluate", "refine")] == [(1, 2), (0, 3)]


def test_what_changed_settings_have_done_again_waits(workspace, mugs, ops, monkeypatch) -> None:
    monkeypatch.setattr(operations, "WINDOW", timedelta(days=1))  # the shapes were made when the tests began
    job = workspace.catalog.enqueue_job(mugs.collection_id, JobKind.PREPROCESS)
    workspace.catalog.claim_job("node-7")
    workspace.catalog.heartbeat_job(job.id, "node-7", Progress(1, 0, 3))
    assert [_counts(ops(), stage) for stage in ("mesh", "describe", "refine")] == [(3, 0), (1, 2), (3, 0)]


def test_a_job_that_has_counted_nothing_yet_does_nothing_again(workspace, mugs, ops, monkeypatch) -> None:
    monkeypatch.setattr(operations, "WINDOW", timedelta(days=1))
    workspace.catalog.enqueue_job(mugs.collection_id, JobKind.REFINE)
    workspace.catalog.claim_job("node-7")
    assert _counts(ops(), "refine") == (3, 0)


def _counts(shown: dict, stage: str) -> tuple[int, int]:
    (found,) = [each for each in shown["stages"] if each["stage"] == stage]
    return found["done"], found["remaining"]


def test_leases_are_counted(annotator, workspace, mugs, ops) -> None:
    annotator.post("/queue/claim", json={"collection_id": mugs.collection_id})
    annotator.post("/queue/claim", json={"collection_id": mugs.collection_id, "is_prefetch": True})
    workspace.catalog.claim_shape(mugs.ids["sub/c.off"], workspace.catalog.add_person("ben").id, 1e-6)
    shown = ops()
    assert shown["leases"] == {"held": 2, "prefetched": 1, "expired": 1, "people": 1}
    assert (shown["queue"]["free"], shown["queue"]["held"]) == (1, 2)


def test_scores_say_which_model_they_are_of(workspace, mugs, ops) -> None:
    collection = workspace.catalog.get_collection("mugs")
    second = save_model(workspace, collection)
    probabilities = {mugs.ids["a.off"]: np.tile([0.5, 0.5], (mugs.meshes["a.off"].n_faces, 1))}
    publish_evaluation(workspace, second, (1, 2), probabilities)
    shown = ops()
    assert shown["score_name"] == "entropy"
    rows = [(row["model_version"], row["shapes"]) for row in shown["freshness"]]
    assert rows == [(2, 1), (1, 2)]
    assert sum(row["share"] for row in shown["freshness"]) == pytest.approx(1)


def test_what_the_workspace_takes(ops) -> None:
    shown = ops()
    assert shown["disk"]["database_bytes"] > 0
    assert shown["disk"]["array_bytes"] == sum(block["bytes"] for block in shown["blocks"]) > 0
    assert shown["disk"]["free_bytes"] > 0
    assert {"mesh", "features"} <= {block["kind"] for block in shown["blocks"]}


def test_workers_show_by_their_jobs(workspace, mugs, ops) -> None:
    job = workspace.catalog.enqueue_job(mugs.collection_id, JobKind.EVALUATE)
    workspace.catalog.claim_job("node-7")
    workspace.catalog.heartbeat_job(job.id, "node-7", Progress(2, 0, 3, ""))
    (worker,) = ops()["workers"]
    assert (worker["owner"], worker["job_kind"], worker["done"], worker["total"]) == ("node-7", "evaluate", 2, 3)
    assert worker["silent_s"] >= 0
    assert (worker["is_busy"], worker["usage"]) == (True, None)


def test_workers_tell_what_they_take_at_work_or_not(workspace, mugs, ops) -> None:
    catalog = workspace.catalog
    catalog.enqueue_job(mugs.other_id, JobKind.TRAIN)
    catalog.claim_job("node-8")
    catalog.note_worker("node-7", WorkerUsage(10**9, 2, 3 * 10**9, 10**12))
    catalog.note_worker("node-8", WorkerUsage(10**8))
    idle, elsewhere = ops()["workers"]
    assert (idle["owner"], idle["is_busy"], idle["job_id"]) == ("node-7", False, None)
    assert idle["usage"] == {
        "memory_bytes": 10**9,
        "n_actors": 2,
        "actor_bytes": 3 * 10**9,
        "free_bytes": 10**12,
    }
    assert (elsewhere["is_busy"], elsewhere["job_id"], elsewhere["done"]) == (True, None, None)
    assert elsewhere["usage"]["free_bytes"] is None


def test_figures_are_kept_for_some_seconds(workspace, mugs, clock, ops) -> None:
    before = ops()
    workspace.catalog.record_failure(NewFailure(mugs.ids["a.off"], "remesh", "k9", "why"))
    assert ops() == before
    clock.now_s += 60
    assert ops()["failures"] != before["failures"]


def test_people_at_work(operator, mugs, confirmed) -> None:
    for active_s in (20.0, 40.0):
        confirmed(active_s)
    (ann,) = operator.get("/ops/people", params={"collection": mugs.collection_id}).json()["items"]
    assert (ann["name"], ann["labels"], ann["seconds_per_shape"], ann["clicks_per_shape"]) == ("ann", 2, 30, 6)
    assert (ann["labels_per_h"], ann["blind_accuracy"]) == (120, None)


def test_people_who_confirmed_nothing_lately_are_left_out(operator, mugs, confirmed) -> None:
    confirmed(20.0)
    query = {"collection": mugs.collection_id, "days": 1e-9}
    assert operator.get("/ops/people", params=query).json()["items"] == []


def test_people_of_another_collection_are_not_there(issue, mugs) -> None:
    stranger = issue("sam", Role.OPERATOR, (mugs.other_id,))
    assert stranger.get("/ops/people", params={"collection": mugs.collection_id}).status_code == 404


def test_rounds_go_from_model_to_model(operator, workspace, mugs, confirmed, reference_id) -> None:
    confirmed(5.0, 0.1, NewBlindCheck(reference_id, Closeness(0.8, 0.7, 0.1)))
    save_model(workspace, workspace.catalog.get_collection("mugs"))
    found = operator.get(f"/collections/{mugs.collection_id}/rounds").json()
    newest, first = found["items"]
    assert (newest["model_version"], newest["n_scored"], newest["mean_score"], newest["n_checks"]) == (2, 0, None, 0)
    assert (first["model_version"], first["n_scored"], first["n_checks"], first["blind_accuracy"]) == (1, 3, 1, 0.8)
    assert first["mean_score"] > 0


def test_a_round_keeps_its_mean_when_a_newer_model_scores(operator, workspace, mugs) -> None:
    path = f"/collections/{mugs.collection_id}/rounds"
    before = operator.get(path).json()["items"][0]
    second = save_model(workspace, workspace.catalog.get_collection("mugs"))
    probabilities = {mugs.ids["a.off"]: np.tile([0.5, 0.5], (mugs.meshes["a.off"].n_faces, 1))}
    publish_evaluation(workspace, second, (1, 2), probabilities)
    newest, first = operator.get(path).json()["items"]
    assert first == before
    assert newest["mean_score"] == pytest.approx(np.log(2), rel=1e-3)


@pytest.mark.parametrize("path", ["/collections/{id}/ops", "/collections/{id}/rounds", "/ops/people?collection={id}"])
def test_figures_of_operation_are_for_operators(reviewer, mugs, path) -> None:
    assert reviewer.get(path.format(id=mugs.collection_id)).status_code == 403


def test_reviewers_read_why_shapes_were_skipped(annotator, reviewer, mugs) -> None:
    for key, reason in (("b.off", "two mugs in one"), ("sub/c.off", "a hole")):
        wanted = {"collection_id": mugs.collection_id, "shape_ids": [mugs.ids[key]]}
        (lease,) = annotator.post("/queue/claim", json=wanted).json()["items"]
        annotator.post(f"/leases/{lease['id']}/skip", json={"reason": reason})
    path = f"/collections/{mugs.collection_id}/skips"
    first = reviewer.get(path, params={"limit": 1}).json()
    (newest,) = first["items"]
    assert (newest["source_key"], newest["person_name"], newest["reason"]) == ("sub/c.off", "ann", "a hole")
    second = reviewer.get(path, params={"limit": 1, "before": first["next"]}).json()
    assert [each["reason"] for each in second["items"]] == ["two mugs in one"]
    assert reviewer.get(path).json()["next"] is None
    assert annotator.get(path).status_code == 403
