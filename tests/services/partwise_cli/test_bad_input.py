"""What goes wrong around Partwise: one line that names file, rule, value and remedy; nothing half-written."""

import re
import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from partwise.errors import ConfigError, FileFormatError, StoreError
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh
from partwise.testing.meshes import subdivided
from partwise.workspace.workspace import open_workspace

CLOSED_PORT = "127.0.0.1:9"
NO_DATABASE = {"PARTWISE_DATABASE_URL": f"postgresql://nobody@{CLOSED_PORT}/none"}
NO_STORE = {
    "PARTWISE_STORE_URL": "s3://bucket/prefix",
    "AWS_ENDPOINT_URL": f"http://{CLOSED_PORT}",
    "AWS_ACCESS_KEY_ID": "nobody",
    "AWS_SECRET_ACCESS_KEY": "nothing",
}
PATIENCE_S = 60
"""Far more than a command needs that gives up by itself, far less than the drivers' own patience."""

PROGRESS = re.compile(r"\w+: [\d,]+ of [\d,]+")


def _one_line(ended: "subprocess.CompletedProcess[str]", code: int, *words: str) -> None:
    assert (ended.returncode, ended.stdout) == (code, "")
    lines = [line for line in ended.stderr.splitlines() if not PROGRESS.match(line)]
    assert len(lines) == 1
    assert lines[0].startswith("error: ")
    assert [word for word in words if word not in ended.stderr] == []


# Stores that cannot be reached


@pytest.mark.parametrize(
    ("environment", "words"),
    [(NO_DATABASE, (CLOSED_PORT, "Connection refused")), (NO_STORE, ("s3://bucket/prefix", CLOSED_PORT))],
)
def test_a_store_out_of_reach_is_given_up_soon_and_makes_no_half_workspace(
    run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, environment: dict[str, str], words: tuple[str, ...]
) -> None:
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    ended = run("init", "ws", "-c", "mugs", "--parts", "body", timeout_s=PATIENCE_S)
    _one_line(ended, 4, *words, "reachable?")
    assert not (tmp_path / "ws").exists()


def test_a_database_out_of_reach_ends_what_needs_it(invoke, described: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in NO_DATABASE.items():
        monkeypatch.setenv(name, value)
    assert isinstance(invoke("queue", described).exception, StoreError)


def test_a_store_url_that_is_none_says_where_it_stands(invoke, empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PARTWISE_STORE_URL", "shelf://left")
    result = invoke("status", empty)
    assert isinstance(result.exception, ConfigError)
    assert "PARTWISE_STORE_URL: [stores] array_url" in str(result.exception)
    assert "shelf://left" in str(result.exception)


# Disks that are full


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 1 MB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk], capture_output=True, check=False)
    if mounted.returncode:
        pytest.skip("making a small file system needs the rights of root")
    yield disk
    subprocess.run(["umount", "-l", disk], check=True)


@pytest.fixture
def large(tmp_path: Path, tetrahedron: TriMesh) -> Path:
    """A folder with a small mesh and one of 1.5 MB."""
    mesh = tetrahedron
    for _ in range(7):
        mesh = subdivided(mesh)
    write_mesh(tetrahedron, tmp_path / "in" / "a.off")
    write_mesh(mesh, tmp_path / "in" / "b.off")
    return tmp_path / "in"


def test_a_full_disk_ends_ingest_and_leaves_no_row_without_its_file(
    run, empty: Path, small_disk: Path, large: Path
) -> None:
    shutil.copytree(empty, small_disk / "ws")
    _one_line(run("ingest", small_disk / "ws", large), 4, "arrays", "no room", "free some space")
    with open_workspace(small_disk / "ws") as workspace:
        assert list(workspace.catalog.shapes(1)) == []
        stored = workspace.arrays.list("sources")
        assert [len(workspace.arrays.get_bytes(key)) for key in stored] == [(large / "a.off").stat().st_size]
    (large / "b.off").unlink()
    assert run("ingest", small_disk / "ws", large).returncode == 0


def test_a_full_disk_makes_no_half_workspace(run, small_disk: Path) -> None:
    (small_disk / "ballast").write_bytes(b"\0" * (1024 * 1024 - 16 * 1024))
    _one_line(run("init", small_disk / "ws", "-c", "mugs", "--parts", "body"), 4, str(small_disk / "ws"), "free")
    assert not (small_disk / "ws").exists()


def test_a_full_disk_makes_no_half_export(run, refined: Path, small_disk: Path) -> None:
    (small_disk / "ballast").write_bytes(b"\0" * (1024 * 1024 - 8 * 1024))
    arguments = ("export", refined, small_disk / "out", "--segmentation", "refined", "--format", "ply")
    _one_line(run(*arguments), 4, str(small_disk / "out"), "No space left", "free space")
    assert not (small_disk / "out").exists()


def test_a_full_disk_commits_no_labels(run, described: Path, small_disk: Path, tmp_path: Path) -> None:
    shutil.move(described / "catalog.sqlite", small_disk / "catalog.sqlite")
    (described / "partwise.toml").write_text(f'[stores]\ndatabase_url = "sqlite:///{small_disk}/catalog.sqlite"\n')
    free = shutil.disk_usage(small_disk).free
    (small_disk / "ballast").write_bytes(b"\0" * (free - 4096))
    (tmp_path / "a.seg").write_text("1\n1\n2\n2\n")
    _one_line(run("confirm", described, "a.off", tmp_path / "a.seg"), 4, "catalog", "free")
    (small_disk / "ballast").unlink()
    with open_workspace(described) as workspace:
        assert list(workspace.catalog.revisions(1)) == []
    assert run("confirm", described, "a.off", tmp_path / "a.seg").returncode == 0


def test_a_limit_on_file_sizes_is_a_full_disk_of_sorts(run, empty: Path, large: Path) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1024 * 1024, 1024 * 1024))

    _one_line(run("ingest", empty, large, preexec_fn=limit), 4, "arrays", "File too large")
    with open_workspace(empty) as workspace:
        assert list(workspace.catalog.shapes(1)) == []


# Files that are wrong: see also the tests of ingest and of labels


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("missing.off", None, "No such file"),
        ("empty.off", "", "empty"),
        ("truncated.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "truncated"),
        ("nan.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "nan"),
        ("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "index 7"),
        ("faceless.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "faces"),
        ("shape.xyz", "0 0 0", "suffix"),
    ],
)
def test_a_wrong_mesh_file_is_named(invoke, tmp_path: Path, name: str, text: str | None, words: str) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    result = invoke("bench", "describe", tmp_path / name)
    assert isinstance(result.exception, FileFormatError)
    assert str(tmp_path / name) in str(result.exception)
    assert words in str(result.exception)
    assert result.stdout == ""


def test_a_wrong_mesh_file_is_one_line(run, tmp_path: Path) -> None:
    (tmp_path / "empty.off").write_text("")
    _one_line(run("bench", "describe", "empty.off"), 3, "empty.off", "was the download cut off?")


def test_a_wrong_configuration_is_named(invoke, empty: Path) -> None:
    (empty / "partwise.toml").write_text("[workers]\nn_actors = -2\n")
    result = invoke("status", empty)
    assert isinstance(result.exception, ConfigError)
    assert f"{empty}/partwise.toml: [workers] n_actors must be" in str(result.exception)


def test_a_file_in_the_place_of_the_array_store_is_named(invoke, empty: Path) -> None:
    (empty / "arrays").rmdir()
    (empty / "arrays").write_text("")
    result = invoke("status", empty)
    assert isinstance(result.exception, StoreError)
    assert f"{empty}/arrays" in str(result.exception)
