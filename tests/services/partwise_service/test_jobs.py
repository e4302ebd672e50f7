"""Jobs over HTTP: who may ask for them, how far they are, and how they are ended and tried again."""

import pytest

from partwise.store.records import JobKind, JobState, Progress, Role


def _of(mugs, ending: str = "") -> str:
    return f"/collections/{mugs.collection_id}/jobs{ending}"


@pytest.fixture
def running(workspace, mugs):
    """A training that its owner has begun."""
    workspace.catalog.enqueue_job(mugs.collection_id, JobKind.TRAIN)
    return workspace.catalog.claim_job("w1")


def test_a_job_is_asked_for_and_shown(operator, mugs) -> None:
    answer = operator.post(_of(mugs), json={"kind": "evaluate"})
    assert answer.status_code == 201
    job = answer.json()
    assert (job["kind"], job["state"], job["attempts"], job["collection_id"]) == (
        "evaluate",
        "pending",
        0,
        mugs.collection_id,
    )
    assert job["progress"] == {"done": 0, "failed": 0, "total": None, "message": ""}
    assert operator.get(f"/jobs/{job['id']}").json() == job
    assert operator.get(_of(mugs)).json() == {"items": [job], "next": None}


def test_asking_twice_is_asking_once(operator, mugs) -> None:
    first, second = (operator.post(_of(mugs), json={"kind": "train"}).json() for _ in range(2))
    assert first["id"] == second["id"]


@pytest.mark.parametrize("body", [{"kind": "dance"}, {"kind": "ingest"}, {"kind": "train", "parameters": {"a": 1}}, {}])
def test_what_is_no_job_is_refused(operator, mugs, body) -> None:
    assert operator.post(_of(mugs), json=body).status_code == 422


def test_reviewers_begin_trainings_and_nothing_else(annotator, reviewer, mugs) -> None:
    assert annotator.post(_of(mugs), json={"kind": "train"}).status_code == 403
    assert reviewer.post(_of(mugs), json={"kind": "train"}).status_code == 201
    assert reviewer.post(_of(mugs), json={"kind": "preprocess"}).status_code == 403


def test_pages_of_jobs_by_state(operator, workspace, mugs) -> None:
    ids = [workspace.catalog.enqueue_job(mugs.collection_id, kind).id for kind in (JobKind.TRAIN, JobKind.REFINE)]
    first = operator.get(_of(mugs), params={"limit": 1}).json()
    second = operator.get(_of(mugs), params={"limit": 1, "before": first["next"]}).json()
    assert [page["items"][0]["id"] for page in (first, second)] == [ids[1], ids[0]]
    assert operator.get(_of(mugs), params={"state": "done"}).json() == {"items": [], "next": None}


def test_how_far_a_job_is(annotator, workspace, running) -> None:
    workspace.catalog.heartbeat_job(running.id, "w1", Progress(3, 1, 10, "half way"))
    shown = annotator.get(f"/jobs/{running.id}").json()
    assert shown["progress"] == {"done": 3, "failed": 1, "total": 10, "message": "half way"}
    assert (shown["message"], shown["state"]) == ("half way", "running")
    assert "w1" not in str(shown)


def test_what_names_files_and_places_is_for_operators(annotator, reviewer, operator, workspace, mugs) -> None:
    job = workspace.catalog.enqueue_job(mugs.collection_id, JobKind.INGEST, {"prefix": "scans", "path": "secret"})
    workspace.catalog.claim_job("w1")
    why = {"why": "s3://bucket cannot be reached"}
    workspace.catalog.finish_job(job.id, "w1", JobState.FAILED, message="ingest could not be done", result=why)
    for caller in (annotator, reviewer):
        for shown in (caller.get(f"/jobs/{job.id}").json(), *caller.get(_of(mugs)).json()["items"]):
            assert (shown["parameters"], shown["result"]) == ({}, None)
            assert shown["message"] == shown["progress"]["message"] == "ingest could not be done"
    shown = operator.get(f"/jobs/{job.id}").json()
    assert (shown["parameters"], shown["result"]) == ({"prefix": "scans", "path": "secret"}, why)
    assert shown["message"] == shown["progress"]["message"] == why["why"]


def test_a_waiting_job_is_cancelled_at_once(reviewer, mugs) -> None:
    job = reviewer.post(_of(mugs), json={"kind": "train"}).json()
    assert reviewer.post(f"/jobs/{job['id']}/cancel").json()["state"] == "cancelled"
    assert reviewer.post(f"/jobs/{job['id']}/cancel").status_code == 409


def test_a_running_job_is_asked_to_stop(annotator, reviewer, workspace, running) -> None:
    assert annotator.post(f"/jobs/{running.id}/cancel").status_code == 403
    asked = reviewer.post(f"/jobs/{running.id}/cancel").json()
    assert (asked["state"], asked["cancel_requested"]) == ("running", True)
    assert workspace.catalog.heartbeat_job(running.id, "w1").cancel_requested


def test_a_failed_job_is_tried_again(annotator, reviewer, workspace, running) -> None:
    assert reviewer.post(f"/jobs/{running.id}/retry").status_code == 409
    workspace.catalog.finish_job(running.id, "w1", JobState.FAILED, message="no labels")
    assert annotator.post(f"/jobs/{running.id}/retry").status_code == 403
    again = reviewer.post(f"/jobs/{running.id}/retry")
    assert (again.status_code, again.json()["state"]) == (201, "pending")
    assert again.json()["id"] != running.id


@pytest.mark.parametrize(("method", "ending"), [("GET", ""), ("POST", "/cancel"), ("POST", "/retry")])
def test_jobs_of_foreign_collections_are_not_found(issue, workspace, mugs, method, ending) -> None:
    foreign = workspace.catalog.enqueue_job(mugs.other_id, JobKind.TRAIN)
    caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
    assert caller.request(method, f"/jobs/{foreign.id}{ending}").status_code == 404
    assert caller.request(method, f"/jobs/999{ending}").status_code == 404
    assert workspace.catalog.job(foreign.id).state is JobState.PENDING


def test_a_foreign_collection_has_no_jobs(issue, mugs) -> None:
    caller = issue("olga", Role.ADMIN, (mugs.collection_id,))
    path = f"/collections/{mugs.other_id}/jobs"
    assert caller.get(path).status_code == 404
    assert caller.post(path, json={"kind": "train"}).status_code == 404


def test_what_people_do_with_jobs_is_on_the_audit_trail(admin, mugs) -> None:
    job = admin.post(_of(mugs), json={"kind": "train"}).json()
    admin.post(f"/jobs/{job['id']}/cancel")
    admin.post(f"/jobs/{job['id']}/retry")
    entries = admin.get("/audit").json()["items"]
    actions = [entry["action"] for entry in entries if entry["subject"] == f"job {job['id']}"]
    assert sorted(actions) == ["cancel", "enqueue", "retry"]


def test_every_change_of_state_is_an_event(workspace, running) -> None:
    workspace.catalog.heartbeat_job(running.id, "w1", Progress(1, 0, 2, "goes on"))
    workspace.catalog.finish_job(running.id, "w1", JobState.DONE, message="trained")
    told = [event.payload for event in workspace.catalog.events(after=0) if event.payload.get("job_id") == running.id]
    assert [(each["state"], each["done"], each["message"]) for each in told] == [
        ("pending", 0, ""),
        ("running", 0, ""),
        ("running", 1, "goes on"),
        ("done", 1, "trained"),
    ]
    assert {each["job_kind"] for each in told} == {"train"}
