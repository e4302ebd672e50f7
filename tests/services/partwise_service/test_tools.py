"""Tools over HTTP, on a shape of sixteen faces."""

from uuid import uuid4

import numpy as np
import pytest
from safetensors.numpy import load

from partwise.segmentation.parameters import BOUNDARY_PRESETS
from partwise.store.records import Role, Token
from partwise.workspace.workspace import open_workspace
from partwise_service.array_responses import SAFETENSORS
from partwise_service.routes.tools import boundaries_call
from partwise_service.schemas.tools import BoundariesRequest
from partwise_service.security.identity import Identity

JSON = {"Accept": "application/json"}


@pytest.fixture
def shape(mugs) -> str:
    return f"/shapes/{mugs.ids['b.off']}"


@pytest.fixture
def n_faces(mugs) -> int:
    return mugs.meshes["b.off"].n_faces


def _draft(caller, workspace, mugs) -> tuple[int, str]:
    """A draft of b.off of one stroke, by ann: its id and path."""
    n_faces = mugs.meshes["b.off"].n_faces
    body = {"collection_id": mugs.collection_id, "shape_ids": [mugs.ids["b.off"]]}
    lease = caller.post("/queue/claim", json=body).json()["items"][0]
    draft = caller.post(f"/leases/{lease['id']}/draft", json={}).json()
    stroke = {
        "v": 1,
        "kind": "assign",
        "runs": [[0, n_faces]],
        "label": 2,
        "id": str(uuid4()),
        "sequence": 0,
        "base_revision": None,
        "author_id": workspace.catalog.get_person("ann").id,
        "at": "2026-11-22T12:00:00Z",
    }
    caller.post(f"/drafts/{draft['id']}/strokes", json={"expected_sequence": 0, "strokes": [stroke]})
    return draft["id"], f"/drafts/{draft['id']}"


def test_every_tool_answers_from_its_process(annotator, workspace, mugs, shape, n_faces) -> None:
    """One test for all, as each application starts processes of its own."""
    patches = annotator.post(f"{shape}/patches", json={"n_patches": 5, "method": "k_means"})
    assert (patches.status_code, patches.headers["content-type"]) == (200, SAFETENSORS)
    assert patches.headers["cache-control"] == "no-store"
    found = load(patches.content)["labels"]
    assert (found.dtype, found.shape, len(np.unique(found))) == (np.uint32, (n_faces,), 5)

    runs = annotator.post(f"{shape}/patches", json={"n_patches": 5, "method": "k_means"}, headers=JSON).json()
    assert np.repeat(*np.array(runs["runs"]).T).tolist() == found.tolist()
    assert (runs["n_faces"], runs["mesh_hash"]) == (n_faces, mugs.meshes["b.off"].content_hash())

    model = annotator.post(f"{shape}/refine-model", json={"smoothness": 0}, headers=JSON).json()
    assert model["runs"] == [[1, n_faces]]  # the model says body everywhere

    body = {"runs": [[0, n_faces - 1], [2, 1]]}
    filled = annotator.post(f"{shape}/refine-boundaries", json=body, headers=JSON).json()
    assert filled["runs"] == [[2, n_faces]]

    draft_id, path = _draft(annotator, workspace, mugs)
    same = annotator.post(f"{shape}/refine-boundaries", json={"draft_id": draft_id}, headers=JSON).json()
    assert same["runs"] == [[2, n_faces]]
    assert annotator.get(path).json()["n_strokes"] == 1  # a tool changes no draft

    body = {"draft_id": draft_id, "anchor_n_strokes": 1, "omega": 1.0, "preset": "paper"}
    assert annotator.post(f"{shape}/refine-boundaries", json=body, headers=JSON).json() == same

    refused = annotator.post(f"{shape}/patches", json={"n_patches": n_faces + 1})
    assert (refused.status_code, "faces" in refused.json()["detail"]) == (422, True)
    nothing = annotator.post(f"{shape}/refine-boundaries", json={"runs": [[0, n_faces]]})
    assert nothing.status_code == 422


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"runs": [[1, 16]], "draft_id": 1},
        {"runs": [[1, 16]], "anchor_n_strokes": 0},
        {"runs": [[1, 15]]},
        {"runs": [[1, 16]], "anchor_runs": [[1, 17]]},
        {"runs": [[1, 16]], "omega": 1.5},
        {"runs": [[1, 16]], "preset": "best"},
    ],
)
def test_boundaries_that_are_not_said_rightly_are_refused(annotator, shape, body) -> None:
    assert annotator.post(f"{shape}/refine-boundaries", json=body).status_code == 422


def test_a_shape_that_no_model_has_seen_has_nothing_to_refine(operator, mugs) -> None:
    assert operator.post(f"/shapes/{mugs.other_shape_id}/refine-model", json={}).status_code == 404


def test_a_draft_of_another_shape_is_not_found(annotator, workspace, mugs) -> None:
    draft_id, _ = _draft(annotator, workspace, mugs)
    answer = annotator.post(f"/shapes/{mugs.ids['a.off']}/refine-boundaries", json={"draft_id": draft_id})
    assert answer.status_code == 404


@pytest.mark.parametrize("tool", ["patches", "refine-boundaries", "refine-model"])
def test_shapes_outside_the_scope_have_no_tools(annotator, mugs, tool) -> None:
    body = {"patches": {"n_patches": 1}, "refine-boundaries": {"runs": [[1, 4]]}}.get(tool, {})
    assert annotator.post(f"/shapes/{mugs.other_shape_id}/{tool}", json=body).status_code == 404


@pytest.mark.parametrize(("body", "expected"), [({}, 0.75), ({"omega": 0.25}, 0.25), ({"preset": "paper"}, None)])
def test_boundaries_are_refined_as_the_workspace_says(mugs, body, expected) -> None:
    config = mugs.path / "partwise.toml"
    config.write_text(config.read_text() + "\n[boundary]\nangle_weight = 0.75\n")
    with open_workspace(mugs.path) as workspace:
        token = Token(**{**dict.fromkeys(Token.__dataclass_fields__), "person_id": 1, "role": Role.ANNOTATOR})
        shape = workspace.catalog.shapes_by_id([mugs.ids["b.off"]])[mugs.ids["b.off"]]
        wish = BoundariesRequest(runs=[(1, mugs.meshes["b.off"].n_faces)], **body)
        call = boundaries_call.__wrapped__(Identity(token), shape, workspace, wish)  # outside of a request
    wanted = BOUNDARY_PRESETS["paper"].angle_weight if expected is None else expected
    assert call.parameters.angle_weight == wanted
