"""`partwise segment`: the toolbox from file to file, and what it refuses."""

import json
import shlex
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import UUID

import numpy as np
import pytest
import typer

from partwise.errors import ConfigError, FileFormatError, LabelError, MeshError, ParameterError, StoreError
from partwise.exchange.labels_psb import read_psb_labels
from partwise.exchange.ply_labels import read_ply_labels
from partwise.exchange.seg import read_seg, write_seg
from partwise.io.read import read_mesh
from partwise.io.write import write_mesh
from partwise.labels.editor import Editor
from partwise.labels.encoding import labels_sha256
from partwise.labels.operations import Assign, Clear, Undo
from partwise.labels.palette import default_colour
from partwise.labels.schema import Part, PartSchema
from partwise.labels.stroke_json import log_to_json
from partwise.mesh import TriMesh
from partwise.segmentation.boundary_refinement import refine_boundaries
from partwise.segmentation.parameters import PAPER_BOUNDARY, BoundaryParameters
from partwise.segmentation.patches import over_segment
from partwise.testing.meshes import subdivided
from partwise_cli.commands import segment

AT = datetime(2026, 3, 1, 9, tzinfo=UTC)


@pytest.fixture
def mesh_file(tmp_path: Path, tetrahedron: TriMesh) -> Path:
    """A bumpy sphere of 256 faces."""
    mesh = subdivided(subdivided(subdivided(tetrahedron)))
    points = mesh.vertices - mesh.vertices.mean(axis=0)
    bumps = 1 + 0.1 * np.random.default_rng(0).standard_normal((mesh.n_vertices, 1))
    write_mesh(TriMesh(bumps * points / np.linalg.norm(points, axis=1, keepdims=True), mesh.faces), tmp_path / "a.off")
    return tmp_path / "a.off"


@pytest.fixture
def mesh(mesh_file: Path) -> TriMesh:
    return read_mesh(mesh_file)


def _halves(mesh: TriMesh) -> np.ndarray:
    """Parts 1 and 4, three faces unlabelled."""
    labels = np.where(mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0, 4, 1)
    labels[:3] = -1
    return labels


def _log(mesh: TriMesh, base: np.ndarray) -> str:
    schema = PartSchema(1, tuple(Part(k, f"p{k}", default_colour(k)) for k in (1, 2)))
    editor = Editor(mesh, base, schema)
    for n, operation in enumerate((Assign(((0, 10),), 2), Assign(((5, 3),), 1), Clear(), Undo())):
        editor.perform(operation, stroke_id=UUID(int=n), author_id=1, at=AT + timedelta(seconds=4 * n))
    return log_to_json(editor.log())


# What is documented


@pytest.mark.parametrize("page", ["README.md", "docs/segmentation.md"])
def test_documented_commands_are_valid_uses(page: str) -> None:
    text = (Path(__file__).parents[3] / page).read_text(encoding="utf-8")
    lines = [shlex.split(line, comments=True)[2:] for line in text.splitlines() if line.startswith("partwise segment ")]
    assert {words[0] for words in lines} == {"patches", "refine", "replay"}
    group = typer.main.get_command(segment.app)
    for name, *arguments in lines:
        group.commands[name].make_context(name, arguments)  # type: ignore[attr-defined]  # it is a group


# Patches


@pytest.mark.parametrize("method", ["random_walks", "k_means"])
def test_patches_are_those_of_the_library_numbered_from_1(invoke, mesh_file: Path, mesh: TriMesh, method: str) -> None:
    out = mesh_file.with_suffix(".seg")
    result = invoke("segment", "patches", mesh_file, "-n", 7, "--method", method, "--out", out)
    assert result.stdout == f"7 patches in {out}, numbered from 1\n"
    np.testing.assert_array_equal(read_seg(out, mesh.n_faces), over_segment(mesh, method).patches(7) + 1)


def test_each_component_is_a_patch_where_fewer_are_asked_for(invoke, tmp_path: Path, tetrahedron: TriMesh) -> None:
    pair = TriMesh(
        np.vstack([tetrahedron.vertices, tetrahedron.vertices + 5]),
        np.vstack([tetrahedron.faces, tetrahedron.faces + 4]),
    )
    write_mesh(pair, tmp_path / "pair.off")
    out = tmp_path / "pair.seg"
    assert invoke("segment", "patches", tmp_path / "pair.off", "-n", 1, "--out", out).stdout.startswith("2 patches")
    np.testing.assert_array_equal(np.sort(read_seg(out, 8)), np.repeat([1, 2], 4))


def test_the_ending_says_the_format(invoke, mesh_file: Path, mesh: TriMesh) -> None:
    seg, ply, psb = (mesh_file.with_name(name) for name in ("a.seg", "a.ply", "a_labels.txt"))
    for out in (seg, ply, psb):
        assert invoke("segment", "patches", mesh_file, "-n", 5, "--method", "k_means", "--out", out).exit_code == 0
    labels = read_seg(seg, mesh.n_faces)
    np.testing.assert_array_equal(read_ply_labels(ply).labels, labels)
    named = read_psb_labels(psb, mesh.n_faces)
    assert named.part_names == tuple(f"patch {k}" for k in range(1, 6))
    np.testing.assert_array_equal(named.indices + 1, labels)


@pytest.mark.parametrize("count", [0, 257])
def test_more_patches_than_faces_or_none_are_refused_and_nothing_is_written(
    invoke, mesh_file: Path, count: int
) -> None:
    out = mesh_file.with_suffix(".seg")
    result = invoke("segment", "patches", mesh_file, "-n", count, "--out", out)
    assert isinstance(result.exception, ParameterError)
    assert "1 … 256" in str(result.exception)
    assert not out.exists()


def test_an_ending_that_is_no_format_is_refused(invoke, mesh_file: Path) -> None:
    result = invoke("segment", "patches", mesh_file, "--out", mesh_file.with_suffix(".lab"))
    assert isinstance(result.exception, ParameterError)
    assert "_labels.txt, .ply" in str(result.exception)


def test_a_file_in_the_place_of_the_folder_is_named(invoke, mesh_file: Path) -> None:
    out = mesh_file / "a.seg"
    result = invoke("segment", "patches", mesh_file, "--method", "k_means", "--out", out)
    assert isinstance(result.exception, StoreError)
    assert str(out) in str(result.exception)


def test_a_mesh_with_nan_is_refused(invoke, tmp_path: Path) -> None:
    (tmp_path / "nan.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n")
    result = invoke("segment", "patches", tmp_path / "nan.off", "-n", 1, "--out", tmp_path / "nan.seg")
    assert isinstance(result.exception, MeshError | FileFormatError)
    assert "nan.off" in str(result.exception)


# Refinement


@pytest.mark.parametrize(
    ("options", "parameters"),
    [
        ((), BoundaryParameters()),
        (("--preset", "paper"), PAPER_BOUNDARY),
        (("--omega", "1"), BoundaryParameters(angle_weight=1.0)),
    ],
)
def test_refined_labels_are_those_of_the_library(
    invoke, mesh_file: Path, mesh: TriMesh, options: tuple[str, ...], parameters: BoundaryParameters
) -> None:
    from partwise.features.shape_diameter import shape_diameter

    labels, out = _halves(mesh), mesh_file.with_name("b.seg")
    write_seg(mesh_file.with_suffix(".seg"), labels)
    result = invoke("segment", "refine", mesh_file, mesh_file.with_suffix(".seg"), "--out", out, *options)
    expected = refine_boundaries(mesh, labels, parameters, shape_diameter(mesh))
    np.testing.assert_array_equal(read_seg(out, mesh.n_faces), expected)
    n_changed = int((expected != labels)[3:].sum())
    assert result.stdout == f"{n_changed} of 256 faces changed, 3 unlabelled ones filled, in {out}\n"


def test_a_configuration_file_says_how(invoke, mesh_file: Path, mesh: TriMesh, tmp_path: Path) -> None:
    config, out = tmp_path / "partwise.toml", mesh_file.with_name("b.seg")
    config.write_text("[boundary]\nangle_weight = 1\nsmoothness = 3.0\n")
    write_seg(mesh_file.with_suffix(".seg"), _halves(mesh))
    arguments = ("segment", "refine", mesh_file, mesh_file.with_suffix(".seg"), "--out", out, "--config", config)
    assert invoke(*arguments).exit_code == 0
    expected = refine_boundaries(mesh, _halves(mesh), BoundaryParameters(angle_weight=1.0, smoothness=3.0))
    assert (expected != refine_boundaries(mesh, _halves(mesh), BoundaryParameters(angle_weight=1.0))).any()
    np.testing.assert_array_equal(read_seg(out, mesh.n_faces), expected)
    config.write_text("[boundary]\nomega = 1\n")
    assert isinstance(invoke(*arguments).exception, ConfigError)
    assert isinstance(invoke(*arguments, "--preset", "paper").exception, ParameterError)


def test_refining_again_with_the_anchor_changes_nothing(invoke, mesh_file: Path, mesh: TriMesh) -> None:
    first, second, third = (mesh_file.with_name(f"{n}.seg") for n in (1, 2, 3))
    write_seg(first, _halves(mesh))
    invoke("segment", "refine", mesh_file, first, "--out", second)
    result = invoke("segment", "refine", mesh_file, second, "--anchor", first, "--out", third)
    assert result.stdout.startswith("0 of 256 faces changed, 0 unlabelled")


def test_names_of_parts_come_through_and_0_is_unlabelled(invoke, mesh_file: Path, mesh: TriMesh) -> None:
    psb, out = mesh_file.with_name("a_labels.txt"), mesh_file.with_name("b_labels.txt")
    right = np.flatnonzero(_halves(mesh) == 4) + 1
    psb.write_text(f"handle\n{' '.join(map(str, right))}\nbody\n1 2 3\n")
    assert invoke("segment", "refine", mesh_file, psb, "--out", out).exit_code == 0
    refined = read_psb_labels(out, mesh.n_faces)
    assert set(refined.part_names) == {"handle", "body"}
    assert (refined.indices >= 0).all()
    write_seg(mesh_file.with_suffix(".seg"), np.zeros(mesh.n_faces, dtype=np.int64))
    result = invoke("segment", "refine", mesh_file, mesh_file.with_suffix(".seg"), "--out", out)
    assert isinstance(result.exception, LabelError)
    assert "a.seg: refinement needs a labelled face" in str(result.exception)


@pytest.mark.parametrize(
    ("options", "message"),
    [(("--omega", "1.5"), "angle_weight"), (("--omega", "nan"), "angle_weight"), (("--preset", "fine"), "'fine'")],
)
def test_parameters_out_of_range_are_refused(
    invoke, mesh_file: Path, mesh: TriMesh, options: tuple[str, ...], message: str
) -> None:
    write_seg(mesh_file.with_suffix(".seg"), _halves(mesh))
    out = mesh_file.with_name("b.seg")
    result = invoke("segment", "refine", mesh_file, mesh_file.with_suffix(".seg"), "--out", out, *options)
    assert isinstance(result.exception, ParameterError)
    assert message in str(result.exception)
    assert not out.exists()


def test_labels_of_another_mesh_are_refused(invoke, mesh_file: Path) -> None:
    write_seg(mesh_file.with_suffix(".seg"), np.array([1, 2, 3]))
    arguments = ("segment", "refine", mesh_file, mesh_file.with_suffix(".seg"), "--out", mesh_file.with_name("b.seg"))
    assert "another mesh's?" in str(invoke(*arguments).exception)


# Replay


def test_a_log_replays_to_the_labels_it_left_with_its_cost(invoke, mesh_file: Path, mesh: TriMesh) -> None:
    log, out = mesh_file.with_suffix(".json"), mesh_file.with_suffix(".seg")
    log.write_text(_log(mesh, np.zeros(mesh.n_faces, dtype=np.uint16)))
    report = json.loads(invoke("segment", "replay", mesh_file, log, "--out", out, "--json").stdout)
    expected = np.full(mesh.n_faces, -1)
    expected[:10], expected[5:8] = 2, 1
    np.testing.assert_array_equal(read_seg(out, mesh.n_faces), expected)
    assert (report["n_events"], report["n_labelled"], report["n_faces"]) == (4, 10, 256)
    assert report["sha256"] == labels_sha256(np.maximum(expected, 0).astype(np.uint16))
    cost = report["cost"]
    assert (cost["strokes"], cost["commands"], cost["undos"], cost["clicks"], cost["active_s"]) == (2, 1, 1, 4, 12.0)
    shown = invoke("segment", "replay", mesh_file, log, "--out", out).stdout
    assert "4 events replayed: 10 of 256 faces labelled" in shown
    assert "cost: 2 strokes, 4 clicks, 12 s" in shown


def test_a_log_starts_from_the_labels_it_was_made_on(invoke, mesh_file: Path, mesh: TriMesh) -> None:
    log, base, out = mesh_file.with_suffix(".json"), mesh_file.with_name("base.seg"), mesh_file.with_suffix(".seg")
    write_seg(base, np.full(mesh.n_faces, 2))
    log.write_text(_log(mesh, np.full(mesh.n_faces, 2, dtype=np.uint16)))
    result = invoke("segment", "replay", mesh_file, log, "--out", out)
    assert isinstance(result.exception, LabelError)
    assert str(log) in str(result.exception)
    assert not out.exists()
    assert invoke("segment", "replay", mesh_file, log, "--base", base, "--out", out).exit_code == 0
    np.testing.assert_array_equal(np.flatnonzero(read_seg(out, mesh.n_faces) == 1), [5, 6, 7])


def test_a_log_of_another_mesh_or_that_is_none_is_named(
    invoke, mesh_file: Path, mesh: TriMesh, tetrahedron: TriMesh
) -> None:
    log, out = mesh_file.with_suffix(".json"), mesh_file.with_suffix(".seg")
    other = TriMesh(mesh.vertices * 2, mesh.faces)
    log.write_text(_log(other, np.zeros(mesh.n_faces, dtype=np.uint16)))
    for text, error, message in (
        (log.read_text(), LabelError, "must be replayed on its own mesh"),
        ("{}", FileFormatError, "must be an object with format"),
        (log.read_text()[:80], FileFormatError, "cut short"),
    ):
        log.write_text(text)
        result = invoke("segment", "replay", mesh_file, log, "--out", out)
        assert isinstance(result.exception, error)
        assert str(log) in str(result.exception)
        assert message in str(result.exception)
