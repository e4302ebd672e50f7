"""import, confirm, export: what they say and how they end."""

from pathlib import Path

import pytest

from partwise.errors import FileFormatError, LabelError, NotFoundError
from partwise.exchange.export_manifest import damaged_files, read_manifest
from partwise.store.records import RevisionKind
from partwise.workspace.workspace import open_workspace


@pytest.fixture
def seg(tmp_path: Path) -> Path:
    """Labels of a.off and of c.off, four faces each."""
    for name in ("a", "c"):
        (tmp_path / "labels").mkdir(exist_ok=True)
        (tmp_path / "labels" / f"{name}.seg").write_text("1\n1\n2\n-1\n")
    return tmp_path / "labels"


def test_import_counts_what_it_did(invoke, described: Path, seg: Path) -> None:
    first, second = (invoke("import", described, seg) for _ in range(2))
    assert first.stdout == (
        "labels of 2 shapes put on record as imported, 0 unchanged, 0 files refused, 1 shape without a file\n"
    )
    assert second.stdout == (
        "labels of 0 shapes put on record as imported, 2 unchanged, 0 files refused, 1 shape without a file\n"
    )
    assert (first.exit_code, second.exit_code) == (0, 0)


def test_import_goes_on_after_a_wrong_file(invoke, described: Path, seg: Path) -> None:
    (seg / "a.seg").write_text("1\n2\n")
    result = invoke("import", described, seg, "--as", "reference", "--author", "ann")
    assert result.exit_code == 1
    assert result.stderr.count("\n") == 1
    assert f"{seg}/a.seg: 4 faces must have a label each but there are 2" in result.stderr
    assert result.stdout.startswith("labels of 1 shape put on record as reference, 0 unchanged, 1 file refused")
    with open_workspace(described) as workspace:
        shape = workspace.catalog.shape_by_key(1, "c.off")
        assert workspace.catalog.head_revision(shape.id, [RevisionKind.REFERENCE]) is not None
        assert workspace.catalog.head_revision(shape.id) is None


def test_import_before_preprocess_says_so(invoke, ingested: Path, seg: Path) -> None:
    result = invoke("import", ingested, seg)
    assert result.exit_code == 1
    assert result.stderr.count("run `partwise preprocess`") == 2


def test_import_knows_three_kinds(invoke, described: Path, seg: Path) -> None:
    assert invoke("import", described, seg, "--as", "guess").exit_code == 2


def test_confirm_puts_a_revision_on_record(invoke, described: Path, seg: Path) -> None:
    result = invoke("confirm", described, "a.off", seg / "a.seg", "--author", "ann")
    assert (result.exit_code, result.stdout) == (0, "a.off: revision 1 by ann\n")


def test_confirm_takes_a_shapes_number(invoke, described: Path, seg: Path) -> None:
    assert invoke("confirm", described, "1", seg / "a.seg").stdout == "a.off: revision 1 by command line\n"


def test_confirming_the_same_twice_is_no_second_revision(invoke, described: Path, seg: Path) -> None:
    invoke("confirm", described, "a.off", seg / "a.seg")
    result = invoke("confirm", described, "a.off", seg / "a.seg", "--author", "bob")
    assert result.stdout == "a.off: these labels are on record already, as revision 1\n"


@pytest.mark.parametrize(
    ("shape", "text", "kind", "words"),
    [
        ("d.off", "1 1 2 2", NotFoundError, "'d.off'"),
        ("99", "1 1 2 2", NotFoundError, "99"),
        ("a.off", None, FileFormatError, "a.seg"),
        ("a.off", "", FileFormatError, "empty"),
        ("a.off", "1 1 2", LabelError, "4 faces"),
        ("a.off", "1 1 2 7", LabelError, "part id 7"),
    ],
)
def test_confirm_refuses_what_does_not_fit(
    invoke, described: Path, seg: Path, shape: str, text: str | None, kind: type[Exception], words: str
) -> None:
    (seg / "a.seg").unlink() if text is None else (seg / "a.seg").write_text(text)
    result = invoke("confirm", described, shape, seg / "a.seg")
    assert isinstance(result.exception, kind)
    assert words in str(result.exception)
    with open_workspace(described) as workspace:
        assert list(workspace.catalog.revisions(1)) == []


def test_confirm_refuses_a_part_that_is_not_in_the_schema(invoke, described: Path, tmp_path: Path) -> None:
    (tmp_path / "a_labels.txt").write_text("body\n1 2\nhandel\n3 4\n")
    result = invoke("confirm", described, "a.off", tmp_path / "a_labels.txt")
    assert isinstance(result.exception, LabelError)
    assert "did you mean 'handle'?" in str(result.exception)


@pytest.mark.parametrize("segmentation", ["predicted", "refined"])
@pytest.mark.parametrize("file_format", ["seg", "ply"])
def test_export_writes_files_that_verify(
    invoke, refined: Path, tmp_path: Path, segmentation: str, file_format: str
) -> None:
    out = tmp_path / "out"
    result = invoke("export", refined, out, "--segmentation", segmentation, "--format", file_format)
    assert result.stdout == f"{segmentation} labels of 3 shapes written\nmanifest: {out}/manifest.json\n"
    manifest = read_manifest(out / "manifest.json")
    assert damaged_files(manifest, out) == ()
    assert len(manifest.shapes) == 3


def test_export_says_how_many_shapes_have_no_such_labels(invoke, described: Path, seg: Path, tmp_path: Path) -> None:
    invoke("confirm", described, "a.off", seg / "a.seg")
    result = invoke("export", described, tmp_path / "out")
    assert result.stdout.splitlines()[0] == ("confirmed labels of 1 shape written; 2 shapes without confirmed labels")


def test_export_of_nothing_is_refused(invoke, described: Path, tmp_path: Path) -> None:
    assert isinstance(invoke("export", described, tmp_path / "out").exception, NotFoundError)
    assert not (tmp_path / "out").exists()
