"""NPZ beyond the suite: readable by numpy alone, and nothing in it is trusted."""

import io
import json
import zipfile

import numpy as np
import pytest

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.label_npz import read_npz, write_npz
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh
from partwise.exchange.parts import PartEntry, PartTable
from partwise.io.limits import ReadLimits
from partwise.testing.label_formats import labelled_strip, parts_named

DESCRIBED = labelled_strip(9, parts_named("seat", "été"))


@pytest.fixture
def arrays(tmp_path):
    write_npz(tmp_path / "a.npz", DESCRIBED)
    with np.load(tmp_path / "a.npz", allow_pickle=False) as found:
        return dict(found)


def saved(arrays, save=np.savez):
    buffer = io.BytesIO()
    save(buffer, **arrays)
    return buffer.getvalue()


def described_as(arrays, **changes):
    description = {**json.loads(str(arrays["description"])), **changes}
    return saved({**arrays, "description": np.array(json.dumps(description))})


def test_numpy_reads_it(arrays):
    np.testing.assert_array_equal(arrays["labels"], DESCRIBED.labels)
    np.testing.assert_array_equal(arrays["faces"], DESCRIBED.mesh.faces)
    np.testing.assert_array_equal(arrays["vertices"], DESCRIBED.mesh.vertices)
    assert dict(zip(arrays["part_ids"].tolist(), arrays["part_names"].tolist(), strict=True)) == {1: "seat", 3: "été"}


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_what_numpy_saved_again_is_read(arrays, save):
    again = read_npz("a.npz", saved(arrays, save))
    np.testing.assert_array_equal(again.labels, DESCRIBED.labels)


def test_column_order_does_not_matter(arrays):
    again = read_npz("a.npz", saved({**arrays, "faces": np.asfortranarray(arrays["faces"])}))
    np.testing.assert_array_equal(again.mesh.faces, DESCRIBED.mesh.faces)


def test_no_parts(tmp_path):
    blank = DescribedMesh(LabelledMesh(DESCRIBED.mesh, np.full(9, -1)), PartTable(1, ()))
    write_npz(tmp_path / "a.npz", blank)
    assert read_npz(tmp_path / "a.npz").parts == blank.parts


def test_a_label_beyond_int32_is_not_written(tmp_path):
    huge = PartTable(1, (PartEntry(2**40, "huge", "#000000"),))
    with pytest.raises(LabelError, match="at most"):
        write_npz(tmp_path / "a.npz", DescribedMesh(LabelledMesh(DESCRIBED.mesh, np.full(9, 2**40)), huge))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["labels", "description", "vertices"])
def test_pickled_arrays_are_refused(arrays, name):
    pickled = np.empty(arrays[name].shape, dtype=object)
    with pytest.raises(FileFormatError, match=rf"^a\.npz: array {name} .*pickled"):
        read_npz("a.npz", saved({**arrays, name: pickled}))


def test_a_header_that_promises_more_than_there_is(arrays):
    """Numpy's own reader would take the memory first."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for name, values in arrays.items():
            content = io.BytesIO()
            np.save(content, values)
            promised = content.getvalue().replace(b"(9, 3)", b"(99999999999, 3)")
            archive.writestr(f"{name}.npy", promised)
    with pytest.raises(FileFormatError, match="array faces promises"):
        read_npz("a.npz", data.getvalue())


def member(content, **options):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", **options) as archive:
        for name in ("vertices", "faces", "labels", "part_ids", "part_names", "description"):
            archive.writestr(f"{name}.npy", content)
    return data.getvalue()


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"no archive", "zip archive"),
        (member(b"no array"), "numpy's format"),
        (member(b"\x93NUMPY\x03\x00" + bytes(50)), "numpy's format"),
        (member(b"x", compression=zipfile.ZIP_BZIP2), "plain or deflated"),
        (member(bytes(20_000_000), compression=zipfile.ZIP_DEFLATED), "times its size"),
    ],
)
def test_refuses(data, message):
    with pytest.raises(FileFormatError, match=message) as caught:
        read_npz("a.npz", data)
    assert str(caught.value).startswith("a.npz: ")


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        (ReadLimits(max_bytes=3_000), "3000 bytes"),
        (ReadLimits(max_faces=8), "8 faces"),
        (ReadLimits(max_faces=3), "3 faces"),
    ],
)
def test_what_is_over_a_limit(arrays, limits, message):
    small = saved(arrays, np.savez_compressed)
    assert len(small) < 3_000
    with pytest.raises(FileFormatError, match=message):
        read_npz("a.npz", small, limits)


def test_unused_vertices_count_too(arrays):
    many = {**arrays, "vertices": np.zeros((28, 3))}
    with pytest.raises(FileFormatError, match="27 vertices"):
        read_npz("a.npz", saved(many), ReadLimits(max_faces=9))


@pytest.mark.parametrize("name", ["vertices", "faces", "labels", "part_ids", "part_names", "description"])
def test_a_missing_array(arrays, name):
    del arrays[name]
    with pytest.raises(FileFormatError, match=f"lacks {name}"):
        read_npz("a.npz", saved(arrays))


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"vertices": np.zeros((12, 3), dtype=np.int64)}, FileFormatError, "array vertices"),
        ({"faces": np.zeros((9, 3))}, FileFormatError, "array faces"),
        ({"faces": np.zeros((9, 2), dtype=np.int64)}, FileFormatError, "faces must be"),
        ({"faces": np.full((9, 3), 99)}, FileFormatError, "index 99"),
        ({"vertices": np.full((12, 3), np.nan)}, FileFormatError, "finite"),
        ({"labels": np.zeros((9, 1), dtype=np.int64)}, FileFormatError, "array labels"),
        ({"labels": np.ones(8, dtype=np.int64)}, LabelError, "9 faces"),
        ({"labels": np.full(9, 2)}, LabelError, "face 0 has 2"),
        ({"description": np.array("{")}, FileFormatError, "must be JSON"),
        ({"description": np.array("7")}, FileFormatError, "of format"),
        ({"description": np.array(7)}, FileFormatError, "array description"),
    ],
)
def test_arrays_that_do_not_fit(arrays, changes, error, message):
    with pytest.raises(error, match=message) as caught:
        read_npz("a.npz", saved({**arrays, **changes}))
    assert str(caught.value).startswith("a.npz: ")


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"format": "other"}, FileFormatError, "of format"),
        ({"format_version": 2}, FileFormatError, "version must be 1"),
        ({"schema": None}, FileFormatError, "the schema"),
        ({"provenance": {}}, FileFormatError, "the provenance"),
        ({"mesh_hash": "0" * 64}, LabelError, "of mesh"),
        ({"mesh_hash": None}, LabelError, "of mesh"),
    ],
)
def test_descriptions_that_do_not_fit(arrays, changes, error, message):
    with pytest.raises(error, match=message):
        read_npz("a.npz", described_as(arrays, **changes))
