"""The provenance card: what is on record of a shape, and nothing where nothing is."""

from dataclasses import asdict

import pytest

from partwise.geometry.manifold import manifold_report
from partwise.store.array_store import BlockAddress
from partwise.store.block_kinds import MESH, REMESH
from partwise.store.levels import remeshed_arrays
from partwise.store.meshes import mesh_arrays
from partwise.store.records import MeshRole, NewBlock, NewFailure, NewMesh, NewStageRun
from partwise.testing.meshes import subdivided
from partwise.workspace.provenance import LOG_LINES, MeshCard, provenance

AS_IS = {
    "method": "as is",
    "parameters": {},
    "core_s": 0.01,
    "n_faces": 4,
    "dropped_area": 0.0,
    "distance": 0.0,
    "refused": "2 components",
}
WRAP = {
    **AS_IS,
    "method": "alpha wrap",
    "parameters": {"alpha_percent": 0.3},
    "core_s": 4.5,
    "distance": 0.12,
    "refused": None,
}
LEVELS = [
    {
        "n_faces": 50,
        "reached": None,
        "mesh_hash": None,
        "method": "",
        "distance": None,
        "absent": "too few",
        "core_s": 0.0,
    },
    {
        "n_faces": 16,
        "reached": 16,
        "mesh_hash": "m",
        "method": "libigl",
        "distance": 0.1,
        "absent": None,
        "core_s": 0.2,
    },
]


def _publish(workspace, kind, address: BlockAddress, run: NewStageRun, role: MeshRole) -> None:
    new = NewBlock(address.name, kind.name, address.n_shapes, address.n_bytes, address.checksum)
    made = run.summary
    mesh = NewMesh(run.shape_id, made["mesh_hash"], made["n_vertices"], made["n_faces"], 0, role)
    workspace.catalog.publish_block(new, [run], meshes=[mesh])


def _account(mesh) -> dict:
    return {"mesh_hash": mesh.content_hash(), "n_vertices": mesh.n_vertices, "n_faces": mesh.n_faces}


@pytest.fixture
def remeshed(filled):
    """a.off read, remeshed by a wrap, and reduced to 16 faces."""
    original, working = filled.meshes["a.off"], subdivided(filled.meshes["a.off"])
    shape_id, arrays = filled.ids["a.off"], filled.workspace.arrays
    read = {**_account(original), "report": asdict(manifold_report(original))}
    address = arrays.write_block(MESH, [mesh_arrays(original)])
    _publish(filled.workspace, MESH, address, NewStageRun(shape_id, "mesh", "k1", 0, 1, 0.5, read), MeshRole.ORIGINAL)
    made = {
        **_account(working),
        "original_mesh_hash": original.content_hash(),
        "is_as_is": False,
        "policy": "auto",
        "working_faces": 16,
        "working_level": 16,
        "attempts": [AS_IS, WRAP],
        "levels": LEVELS,
    }
    address = arrays.write_block(REMESH, [remeshed_arrays(working, [(50, None), (16, working)])])
    _publish(
        filled.workspace, REMESH, address, NewStageRun(shape_id, "remesh", "k2", 0, 2, 7.5, made), MeshRole.WORKING
    )
    return filled


def _card(filled):
    return provenance(filled.workspace, filled.shape("a.off"))


def test_an_ingested_shape_has_a_source_and_no_more(filled) -> None:
    card = _card(filled)
    assert (card.source_key, card.source_hash, card.state) == ("a.off", filled.shape("a.off").source_hash, "new")
    assert (card.original, card.working, card.attempts, card.levels, card.stages) == (None, None, (), (), ())


def test_meshes_are_named_by_what_they_are_to_the_shape(remeshed) -> None:
    original, working = remeshed.meshes["a.off"], subdivided(remeshed.meshes["a.off"])
    card = _card(remeshed)
    assert card.original.mesh == MeshCard(original.content_hash(), 4, 4)
    assert card.original.report == manifold_report(original)
    assert card.working.mesh == MeshCard(working.content_hash(), working.n_vertices, 16)
    assert (card.working.is_as_is, card.working.working_faces, card.working.level) == (False, 16, 16)


def test_attempts_and_levels_are_as_recorded(remeshed) -> None:
    card = _card(remeshed)
    assert [asdict(attempt) for attempt in card.attempts] == [AS_IS, WRAP]
    assert [asdict(level) for level in card.levels] == LEVELS


def test_stages_come_in_order_with_key_seconds_attempts_and_block(remeshed) -> None:
    run = remeshed.workspace.catalog.stage_runs([remeshed.ids["a.off"]], "remesh")[remeshed.ids["a.off"]]
    mesh, remesh = _card(remeshed).stages
    assert (mesh.stage, remesh.stage) == ("mesh", "remesh")
    assert (remesh.key, remesh.seconds, remesh.attempts) == ("k2", 7.5, 2)
    assert (remesh.block, remesh.row, remesh.failure) == (run.block_name, 0, None)


def _fail(filled, stage: str, detail: dict) -> None:
    filled.workspace.catalog.record_failure(NewFailure(filled.ids["a.off"], stage, "k9", "too thin", 3, 9.0, detail))


def test_a_failure_has_its_reason_its_kind_and_the_end_of_its_log(filled) -> None:
    log = "\n".join(f"line {number}" for number in range(100))
    _fail(filled, "describe", {"kind": "crash", "log": log, "steps": {"attempt 0": "it hung"}})
    (stage,) = _card(filled).stages
    assert (stage.stage, stage.attempts, stage.failure.reason, stage.failure.kind) == (
        "describe",
        3,
        "too thin",
        "crash",
    )
    assert stage.failure.steps == (("attempt 0", "it hung"),)
    assert stage.failure.log == tuple(f"line {number}" for number in range(100 - LOG_LINES, 100))


def test_an_unforeseen_error_shows_its_traceback(filled) -> None:
    _fail(filled, "mesh", {"traceback": "Traceback …\nZeroDivisionError"})
    assert _card(filled).stages[0].failure.log == ("Traceback …", "ZeroDivisionError")


def test_what_a_refused_shape_was_tried_with_is_on_its_card(filled) -> None:
    _fail(filled, "remesh", {"attempts": [AS_IS, {**WRAP, "refused": "too far"}]})
    card = _card(filled)
    assert [attempt.refused for attempt in card.attempts] == ["2 components", "too far"]
    assert card.working is None


def test_a_shape_that_fails_under_new_settings_shows_both(remeshed) -> None:
    _fail(remeshed, "remesh", {"attempts": [AS_IS]})
    card = _card(remeshed)
    assert [(stage.stage, stage.failure is None) for stage in card.stages] == [
        ("mesh", True), ("remesh", True), ("remesh", False)
    ]  # fmt: skip
    assert len(card.attempts) == 1
    assert card.working is not None
