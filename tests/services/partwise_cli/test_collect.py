"""init, settings, ingest, preprocess, retry, status, gc, migrate: what they say and how they end."""

import json
import zipfile
from pathlib import Path
from typing import get_args

import pytest

from partwise.errors import ConfigError, ConflictError, LabelError, NotFoundError, ParameterError
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.store.records import FailureKind, NewFailure
from partwise.workspace.progress import RunProgress
from partwise.workspace.relabel import RELABEL, MoveReport
from partwise.workspace.status import STAGE_ORDER
from partwise.workspace.workspace import open_workspace
from partwise_cli.commands.collect import FailureReason, StageName
from partwise_workers import passes


def _fail(ws: Path, source_key: str, stage: str, reason: str, kind: str = "error") -> None:
    with open_workspace(ws) as workspace:
        collection = workspace.catalog.get_collection("mugs")
        shape = workspace.catalog.shape_by_key(collection.id, source_key)
        workspace.catalog.record_failure(NewFailure(shape.id, stage, "k", reason, detail={"kind": kind}))


# init


def test_init_says_what_it_made(invoke, tmp_path: Path) -> None:
    result = invoke("init", tmp_path / "ws", "-c", "chairs", "--parts", "seat, back,leg")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == f"{tmp_path}/ws: collection 'chairs' with 3 parts: seat, back, leg\n"
    with open_workspace(tmp_path / "ws") as workspace:
        settings = workspace.catalog.get_collection("chairs").settings
        assert settings == {"up": "y", "working_faces": 10_000, "remesh": "auto"}


def test_init_adds_a_collection_to_a_workspace(invoke, empty: Path) -> None:
    options = ("--up", "z", "--faces", "20000", "--remesh", "never")
    assert invoke("init", empty, "-c", "lamps", "--parts", "shade", *options).exit_code == 0
    with open_workspace(empty) as workspace:
        assert [each.name for each in workspace.catalog.list_collections()] == ["lamps", "mugs"]
        settings = workspace.catalog.get_collection("lamps").settings
        assert settings == {"up": "z", "working_faces": 20_000, "remesh": "never"}


@pytest.mark.parametrize(
    ("collection", "parts", "kind"),
    [("mugs", "body", ConflictError), ("cups", " , ", LabelError), ("cups", "body,body", LabelError)],
)
def test_init_refuses_a_wrong_collection(invoke, empty: Path, collection: str, parts: str, kind: type) -> None:
    assert isinstance(invoke("init", empty, "-c", collection, "--parts", parts).exception, kind)


def test_init_refuses_a_resolution_out_of_range(invoke, tmp_path: Path) -> None:
    result = invoke("init", tmp_path / "ws", "-c", "cups", "--parts", "body", "--faces", "3")
    assert isinstance(result.exception, ParameterError)
    assert not (tmp_path / "ws").exists()


# settings


def test_settings_are_shown(invoke, empty: Path) -> None:
    words = invoke("settings", empty).stdout.split()
    assert " ".join(words[:3]) == "Settings of mugs"
    for name, value in (("up", "y"), ("faces", "10000"), ("remesh", "auto")):
        assert words[words.index(name) + 2] == value


def test_settings_are_changed_and_say_what_comes_of_it(invoke, empty: Path) -> None:
    result = invoke("settings", empty, "--faces", "20000")
    assert "│ faces            │ 20000 │ 10000  │" in result.stdout
    assert "with the next `partwise preprocess`" in result.stdout
    shown = json.loads(invoke("settings", empty, "--json").stdout)
    assert (shown["up"], shown["working_faces"], shown["remesh"], shown["train_after"]) == ("y", 20_000, "auto", 5)


def test_settings_of_the_queue_are_changed_alike(invoke, empty: Path) -> None:
    options = ("--honeypot-share", "0.1", "--review", "--labels-per-shape", "2", "--json")
    shown = json.loads(invoke("settings", empty, *options).stdout)
    assert (shown["honeypot_share"], shown["review"], shown["labels_per_shape"]) == (0.1, True, 2)
    assert isinstance(invoke("settings", empty, "--agreement", "1.5").exception, ParameterError)


def test_a_change_of_pictures_alone_needs_no_new_meshes(invoke, empty: Path) -> None:
    assert "preprocess" not in invoke("settings", empty, "--up", "z").stdout


def test_settings_out_of_range_are_refused(invoke, empty: Path) -> None:
    assert isinstance(invoke("settings", empty, "--faces", "3").exception, ParameterError)
    assert invoke("settings", empty, "--remesh", "always").exit_code == 2


def test_init_knows_three_axes(invoke, tmp_path: Path) -> None:
    assert invoke("init", tmp_path / "ws", "-c", "c", "--parts", "p", "--up", "w").exit_code == 2
    assert not (tmp_path / "ws").exists()


# ingest


def test_ingest_counts_what_it_did(invoke, empty: Path, tmp_path: Path, tetrahedron: TriMesh) -> None:
    write_mesh(tetrahedron, tmp_path / "in" / "a.off")
    first, second = (invoke("ingest", empty, tmp_path / "in") for _ in range(2))
    assert first.stdout == "1 shape added, 0 unchanged, 0 changed, 0 files refused\n"
    assert second.stdout == "0 shapes added, 1 unchanged, 0 changed, 0 files refused\n"
    assert (first.exit_code, second.exit_code) == (0, 0)


def test_ingest_takes_an_archive_and_a_single_mesh(invoke, empty: Path, tmp_path: Path, tetrahedron: TriMesh) -> None:
    path = tmp_path / "b.off"
    write_mesh(tetrahedron, path)
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.write(path, "deep/a.off")
        archive.write(path, "../c.off")
    results = [invoke("ingest", empty, source) for source in (tmp_path / "a.zip", path)]
    assert [result.exit_code for result in results] == [1, 0]
    assert "../c.off" in results[0].stderr
    with open_workspace(empty) as workspace:
        keys = [shape.source_key for shape in workspace.catalog.shapes(workspace.catalog.get_collection("mugs").id)]
    assert keys == ["deep/a.off", "b.off"]


def test_ingest_needs_a_folder(invoke, empty: Path) -> None:
    result = invoke("ingest", empty, empty / "missing")
    assert isinstance(result.exception, NotFoundError)
    assert str(empty / "missing") in str(result.exception)


def test_a_second_collection_must_be_named(invoke, empty: Path, tmp_path: Path, tetrahedron: TriMesh) -> None:
    write_mesh(tetrahedron, tmp_path / "in" / "a.off")
    invoke("init", empty, "-c", "lamps", "--parts", "shade")
    assert isinstance(invoke("ingest", empty, tmp_path / "in").exception, NotFoundError)
    assert invoke("ingest", empty, tmp_path / "in", "--collection", "lamps").exit_code == 0


# preprocess


@pytest.mark.parametrize(
    ("progress", "line", "code"),
    [
        (RunProgress(1, 0, 1), "1 shape preprocessed, 0 failed\n", 0),
        (RunProgress(2, 1, 3), "2 shapes preprocessed, 1 failed\n", 1),
        (RunProgress(0, 0, 0), "nothing to do\n", 0),
    ],
)
def test_preprocess_says_how_it_went(
    invoke, described: Path, monkeypatch: pytest.MonkeyPatch, progress: RunProgress, line: str, code: int
) -> None:
    monkeypatch.setattr(passes, "preprocess", lambda *_: progress)
    result = invoke("preprocess", described)
    assert (result.stdout, result.exit_code) == (line, code)


def test_preprocess_says_why_shapes_failed(invoke, ingested: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _fail(ingested, "a.off", "mesh", "a.off: faces must be non-empty; is the file truncated?")
    monkeypatch.setattr(passes, "preprocess", lambda *_: RunProgress(2, 1, 3))
    result = invoke("preprocess", ingested)
    assert result.stderr == "warning: a.off: mesh: faces must be non-empty; is the file truncated?\n"


def test_preprocess_says_which_labels_moved_and_ends_badly_where_some_could_not(
    invoke, ingested: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def move(*arguments: object) -> RunProgress:
        arguments[-1](MoveReport(n_moved=3, n_in_review=1, n_failed=1))  # type: ignore[operator]
        return RunProgress(4, 0, 4)

    _fail(ingested, "a.off", RELABEL, "mesh 0123… is no longer stored; preprocess shape 1 again")
    monkeypatch.setattr(passes, "preprocess", move)
    result = invoke("preprocess", ingested)
    assert result.stdout.splitlines() == [
        "4 shapes preprocessed, 0 failed",
        "labels of 3 shapes moved to the working mesh: 1 to be reviewed, 1 failed",
    ]
    assert result.stderr.startswith("warning: a.off: relabel: mesh 0123")
    assert result.exit_code == 1


def test_preprocess_reminds_of_shapes_that_failed_before(
    invoke, ingested: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _fail(ingested, "a.off", "mesh", "too flat")
    monkeypatch.setattr(passes, "preprocess", lambda *_: RunProgress(0, 0, 0))
    result = invoke("preprocess", ingested)
    assert result.exit_code == 0
    assert result.stdout == "nothing to do; 1 shape failed before: see `partwise status`, then `partwise retry`\n"


def test_preprocess_of_nothing_says_what_to_do_first(invoke, empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(passes, "preprocess", lambda *_: RunProgress(0, 0, 0))
    assert "has no shapes; add some with `partwise ingest`" in invoke("preprocess", empty).stdout


# retry


def test_retry_forgets_failures(invoke, ingested: Path) -> None:
    for key in ("a.off", "b.off"):
        _fail(ingested, key, "mesh", "too flat")
    _fail(ingested, "c.off", "describe", "too slow")
    assert invoke("retry", ingested, "--stage", "describe").stdout.startswith("1 failure forgotten")
    assert invoke("retry", ingested).stdout.startswith("2 failures forgotten")
    assert invoke("retry", ingested).stdout == "no failures on record\n"
    assert invoke("retry", ingested, "--stage", "mesh").stdout == "no failures of stage 'mesh' on record\n"


@pytest.mark.parametrize(
    ("options", "n_cleared"),
    [(("--reason", "memory"), 1), (("--text", "TOO"), 2), (("--reason", "deadline", "--text", "flat"), 0)],
)
def test_retry_forgets_what_is_asked_for(invoke, ingested: Path, options: tuple[str, ...], n_cleared: int) -> None:
    _fail(ingested, "a.off", "mesh", "too flat", "error")
    _fail(ingested, "b.off", "mesh", "too large", "memory")
    _fail(ingested, "c.off", "mesh", "it was slow", "deadline")
    said = invoke("retry", ingested, *options).stdout
    assert said.startswith(f"{n_cleared} failure" if n_cleared else "no failures by deadline with 'flat' on record")


def test_retry_knows_every_kind_of_failure() -> None:
    assert set(get_args(FailureReason)) == set(FailureKind)
    assert get_args(StageName) == STAGE_ORDER


# status


def test_status_of_a_new_collection_says_what_to_do_next(invoke, empty: Path) -> None:
    result = invoke("status", empty)
    assert result.exit_code == 0
    assert "go on with `partwise ingest`" in result.stdout
    assert "Model: none yet" in result.stdout


def test_status_of_an_ingested_collection_says_what_to_do_next(invoke, ingested: Path) -> None:
    assert "go on with `partwise preprocess`" in invoke("status", ingested).stdout


def test_status_shows_states_stages_and_model(invoke, refined: Path) -> None:
    words = invoke("status", refined).stdout.split()
    for stage in ("mesh", "describe", "evaluate", "refine"):
        start = words.index(stage)
        assert words[start : start + 5] == [stage, "│", "3", "│", "0"]
    assert " ".join(words).endswith("Model: version 1")


def test_status_lists_failures_on_stderr(invoke, ingested: Path) -> None:
    _fail(ingested, "a.off", "mesh", "too flat")
    assert invoke("status", ingested).stderr == "warning: a.off: mesh: too flat\n"


def test_status_as_json(invoke, refined: Path) -> None:
    document = json.loads(invoke("status", refined, "--json").stdout)
    assert document["collection"] == "mugs"
    assert dict(document["states"])["ready"] == 3
    assert document["stages"][0] == {"stage": "mesh", "n_done": 3, "n_failed": 0}
    assert (document["model_version"], document["failures"]) == (1, [])


# gc and migrate


def test_gc_says_what_it_swept(invoke, refined: Path) -> None:
    result = invoke("gc", refined)
    swept = "0 replaced blocks (0.0 MB), 0 blocks and 0 unfinished writes of crashed runs"
    assert result.stdout == f"{swept}, 0 expired uploads or exports swept\n"
    assert invoke("gc", refined, "--older-than-h", "-1").exit_code == 2


def test_migrate_says_that_it_is_done(invoke, empty: Path) -> None:
    assert invoke("migrate", empty).stdout == f"{empty}: the catalog is up to date\n"


def test_migrate_needs_a_workspace(invoke, tmp_path: Path) -> None:
    assert isinstance(invoke("migrate", tmp_path).exception, ConfigError)
