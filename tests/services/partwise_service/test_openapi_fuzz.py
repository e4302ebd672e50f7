"""What the document says of every operation holds for whatever is sent: found by generated requests.

Most of them go to what is there, an open draft under a lease among it; strokes are such as its author could send.
"""

import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from fastapi import FastAPI
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from schemathesis.specs.openapi.checks import positive_data_acceptance

from partwise.store.catalog import Catalog
from partwise.store.records import Draft, JobKind, NewToken, Role
from partwise.workspace.confirming import begin_draft
from partwise.workspace.workspace import Workspace
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

N_EXAMPLES = 8
STROKES = "/drafts/{draft_id}/strokes"
CONFIRM = "/drafts/{draft_id}/confirm"


@dataclass
class Served:
    """A running application with its document, and an admin who works in it, with their secret."""

    app: FastAPI
    schema: Any
    person_id: int
    secret: str
    collection_id: int
    shape_id: int

    @property
    def workspace(self) -> Workspace:
        opened: Workspace = self.app.state.service.workspace
        return opened

    @property
    def catalog(self) -> Catalog:
        return self.workspace.catalog

    def open_draft(self) -> Draft:
        """The admin's draft of the shape, with a lease; whatever ended the last one."""
        lease = self.catalog.claim_shape(self.shape_id, self.person_id, 3600.0)
        return begin_draft(self.workspace, lease, self.person_id)

    def ids(self, draft: Draft) -> dict[str, Any]:
        """What may stand in a path for what there is."""
        lease = next(each for each in self.catalog.leases_of(self.person_id) if each.shape_id == self.shape_id)
        job = self.catalog.enqueue_job(self.collection_id, JobKind.PREPROCESS)
        return {
            "collection_id": self.collection_id,
            "shape_id": self.shape_id,
            "mesh_hash": draft.mesh_hash,
            "draft_id": draft.id,
            "lease_id": lease.id,
            "job_id": job.id,
            "part_id": 1,
        }


@pytest.fixture(scope="module", params=["sqlite", "postgres"])
def served(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    path = tmp_path_factory.mktemp("fuzz") / "ws"
    if request.param == "sqlite":
        mugs = request.getfixturevalue("template")
        shutil.copytree(mugs.path, path)
    else:
        mugs, reused = request.getfixturevalue("postgres_template")
        reused.restore()
        shutil.copytree(mugs.path, path)
        (path / "partwise.toml").write_text(f'[stores]\ndatabase_url = "{reused.url}"\n')
    app = create_app(ServiceSettings(workspace=path, max_auth_failures=1_000_000, event_stream_s=0.0))
    with ExitStack() as running:
        running.enter_context(TestClient(app))
        catalog = app.state.service.workspace.catalog
        new = NewToken(catalog.add_person("ada").id, Role.ADMIN, datetime.now(UTC) + timedelta(days=1))
        secret = catalog.issue_token(new, "test").secret
        schema = schemathesis.openapi.from_asgi("/api/v1/openapi.json", app)
        yield Served(app, schema, new.person_id, secret, mugs.collection_id, mugs.ids["a.off"])


def _operations() -> list[tuple[str, str]]:
    document = create_app(ServiceSettings(workspace=Path("none"))).openapi()
    return [(method.upper(), path) for path, methods in document["paths"].items() for method in methods]


@pytest.mark.parametrize(("method", "path"), _operations())
def test_operations_keep_to_the_document(served: Served, method: str, path: str) -> None:
    n_recorded = 0

    @settings(
        max_examples=N_EXAMPLES,
        deadline=None,
        derandomize=True,
        database=None,
        phases=(Phase.generate,),  # what fails is told as it was sent, at once
        suppress_health_check=list(HealthCheck),
    )
    @given(case=served.schema[path][method].as_strategy(), is_there=st.sampled_from([True, True, True, False]))
    def keeps_to_the_document(case, is_there: bool) -> None:
        nonlocal n_recorded
        if is_there:
            _lead_to_what_is_there(served, case, path)
        answer = case.call(headers={"Authorization": f"Bearer {served.secret}"})
        case.validate_response(answer, excluded_checks=[positive_data_acceptance])
        is_refused = answer.status_code == 422 and case.meta.generation.mode.is_positive
        # a rule of the domain may refuse what the document allows, such as a part's name with a comma; no schema may
        assert not (is_refused and "errors" in answer.json()), answer.text
        n_recorded += path.endswith(STROKES) and method == "POST" and answer.status_code == 200

    keeps_to_the_document()
    assert n_recorded or not (path.endswith(STROKES) and method == "POST"), "no stroke came on record"


def _lead_to_what_is_there(served: Served, case: Any, path: str) -> None:
    draft = served.open_draft()
    ids = served.ids(draft)
    case.path_parameters = {name: ids.get(name, given) for name, given in (case.path_parameters or {}).items()}
    if path.endswith(STROKES) and isinstance(case.body, dict):
        n_faces = served.catalog.mesh(draft.shape_id, draft.mesh_hash).n_faces
        case.body["expected_sequence"] = draft.n_strokes
        for sequence, stroke in enumerate(case.body.get("strokes", []), start=draft.n_strokes):
            _fit(stroke, n_faces)
            stroke |= {"sequence": sequence, "base_revision": draft.base_revision, "author_id": served.person_id}
    if path.endswith(CONFIRM):
        case.headers["If-Match"] = f'"{draft.n_strokes}"'


def _fit(stroke: dict[str, Any], n_faces: int) -> None:
    """Has a stroke name faces that there are."""
    match stroke.get("kind"):
        case "paint":
            stroke["seeds"] = [seed % n_faces for seed in stroke["seeds"]]
        case "segment_wide":
            stroke["seed"] %= n_faces
        case "assign":
            stroke["runs"] = [[stroke["runs"][0][0] % n_faces, 1]]
