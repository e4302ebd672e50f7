"""The conformance suite of label formats that are read and written face by face."""
# ruff: noqa: S101 # a test suite asserts

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from partwise.errors import FileFormatError, LabelError, PartwiseError, StoreError
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh, Provenance
from partwise.exchange.parts import PartEntry, PartTable
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh
from partwise.testing.expect import raises
from partwise.unlabelled import NO_CLASS

ODD_NAMES = ("Ärmel", "腿", "left  leg", 'quo"te\\', "unlabelled", "a/b", "🪑", "background", "None", "leg.001")
_N_DAMAGED = 80


@dataclass(frozen=True, slots=True)
class LabelFormat:
    """A format as the suite sees it.

    write : a described mesh to a path.
    read : the labels at a path for a mesh, (m,) part ids and −1; raises LabelError where they are not the mesh's.
    described : all that the file holds, for formats that hold mesh and schema; else None.
    knows_count, knows_mesh : whether the file says how many faces, and which mesh, its labels are for.
    """

    suffix: str
    write: Callable[[Path, DescribedMesh], None]
    read: Callable[[Path, TriMesh, PartTable], np.ndarray]
    described: Callable[[Path], DescribedMesh] | None = None
    knows_count: bool = True
    knows_mesh: bool = True


def parts_named(*names: str) -> PartTable:
    """Parts with ids 1, 3, 5, …; each second one is a part of the one before."""
    ids = range(1, 2 * len(names), 2)
    return PartTable(
        4,
        tuple(
            PartEntry(part_id, name, f"#{part_id:06x}", f"what {name} is", part_id - 2 if k % 2 else None)
            for k, (part_id, name) in enumerate(zip(ids, names, strict=True))
        ),
    )


def labelled_strip(n_faces: int, parts: PartTable, seed: int = 1) -> DescribedMesh:
    """A strip of triangles with labels drawn at random, unlabelled among them, and one vertex that no face uses."""
    rng = np.random.default_rng(seed)
    vertices = rng.standard_normal((n_faces + 3, 3)).astype(np.float32).astype(np.float64)
    faces = np.arange(n_faces)[:, None] + np.array([0, 1, 2])
    mesh = TriMesh(vertices, rng.permuted(faces[rng.permutation(n_faces)], axis=1))
    labels = rng.choice(np.array([NO_CLASS, *parts.ids]), n_faces)
    return DescribedMesh(LabelledMesh(mesh, labels), parts, Provenance("a/b.off", "0" * 64, "refined", 3, "0.1"))


def with_labels(described: DescribedMesh, labels: np.ndarray) -> DescribedMesh:
    """The same mesh and schema with other labels."""
    return DescribedMesh(LabelledMesh(described.mesh, labels), described.parts, described.provenance)


class LabelFormatConformance:
    """What every label format must pass. A subclass provides a pytest fixture `label_format`."""

    def _round_trip(self, label_format: LabelFormat, folder: Path, described: DescribedMesh) -> np.ndarray:
        path = folder / f"shape{label_format.suffix}"
        label_format.write(path, described)
        return label_format.read(path, described.mesh, described.parts)

    def test_labels_come_back_in_face_order(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(257, parts_named("seat", "back", "leg"))
        np.testing.assert_array_equal(self._round_trip(label_format, tmp_path, described), described.labels)

    def test_unlabelled_is_not_the_background(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(4, parts_named("background", "seat"))
        described = with_labels(described, np.array([1, NO_CLASS, 3, 1]))
        assert self._round_trip(label_format, tmp_path, described).tolist() == [1, NO_CLASS, 3, 1]

    def test_one_face(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = with_labels(labelled_strip(1, parts_named("all")), np.array([1]))
        assert self._round_trip(label_format, tmp_path, described).tolist() == [1]

    def test_parts_without_faces(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = with_labels(labelled_strip(3, parts_named("seat", "back", "leg")), np.array([3, 3, 3]))
        assert self._round_trip(label_format, tmp_path, described).tolist() == [3, 3, 3]

    def test_no_face_labelled(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = with_labels(labelled_strip(3, parts_named("seat", "back")), np.full(3, NO_CLASS))
        assert self._round_trip(label_format, tmp_path, described).tolist() == [NO_CLASS] * 3

    def test_odd_part_names(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(64, parts_named(*ODD_NAMES))
        np.testing.assert_array_equal(self._round_trip(label_format, tmp_path, described), described.labels)

    def test_mesh_schema_and_provenance_come_back(self, label_format: LabelFormat, tmp_path: Path) -> None:
        if label_format.described is None:
            return
        written = labelled_strip(65, parts_named(*ODD_NAMES))
        label_format.write(tmp_path / f"a{label_format.suffix}", written)
        found = label_format.described(tmp_path / f"a{label_format.suffix}")
        np.testing.assert_array_equal(found.mesh.faces, written.mesh.faces)
        np.testing.assert_array_equal(found.mesh.vertices, written.mesh.vertices)
        assert found.parts == written.parts
        assert found.provenance == written.provenance

    def test_the_same_input_gives_the_same_bytes(self, label_format: LabelFormat, tmp_path: Path) -> None:
        paths = [tmp_path / f"{name}{label_format.suffix}" for name in "ab"]
        for path in paths:
            label_format.write(path, labelled_strip(65, parts_named(*ODD_NAMES)))
        assert paths[0].read_bytes() == paths[1].read_bytes()

    def test_a_failed_write_leaves_nothing(self, label_format: LabelFormat, tmp_path: Path) -> None:
        path = tmp_path / f"taken{label_format.suffix}"
        path.mkdir()
        with raises(StoreError, str(path)):
            label_format.write(path, labelled_strip(5, parts_named("seat")))
        assert list(tmp_path.rglob("*")) == [path]

    def test_labels_of_a_larger_mesh_are_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(40, parts_named("seat", "back"))
        path = tmp_path / f"a{label_format.suffix}"
        label_format.write(path, described)
        smaller = labelled_strip(30, described.parts).mesh
        with raises(LabelError):
            label_format.read(path, smaller, described.parts)

    def test_labels_of_a_smaller_mesh_are_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        if not label_format.knows_count:
            return
        described = labelled_strip(40, parts_named("seat", "back"))
        path = tmp_path / f"a{label_format.suffix}"
        label_format.write(path, described)
        with raises(LabelError):
            label_format.read(path, labelled_strip(41, described.parts).mesh, described.parts)

    def test_labels_of_another_mesh_are_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        if not label_format.knows_mesh:
            return
        described = labelled_strip(40, parts_named("seat", "back"))
        path = tmp_path / f"a{label_format.suffix}"
        label_format.write(path, described)
        with raises(LabelError, "of mesh"):
            label_format.read(path, labelled_strip(40, described.parts, seed=2).mesh, described.parts)

    def test_a_truncated_file_is_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        if not label_format.knows_count:
            return
        described = labelled_strip(200, parts_named("seat", "back"))
        path = tmp_path / f"a{label_format.suffix}"
        label_format.write(path, described)
        data = path.read_bytes()
        for share in (0.02, 0.3, 0.6, 0.95):
            path.write_bytes(data[: int(len(data) * share)])
            with raises(PartwiseError, str(path)):
                label_format.read(path, described.mesh, described.parts)

    def test_an_empty_and_a_missing_file_are_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(5, parts_named("seat"))
        path = tmp_path / f"a{label_format.suffix}"
        with raises(FileFormatError, str(path), "No such file"):
            label_format.read(path, described.mesh, described.parts)
        path.write_bytes(b"\n")
        with raises(FileFormatError, str(path), "empty"):
            label_format.read(path, described.mesh, described.parts)

    def test_a_file_of_absurd_size_is_refused(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(5, parts_named("seat"))
        path = tmp_path / f"a{label_format.suffix}"
        with path.open("wb") as file:
            file.truncate(ReadLimits().max_bytes + 1)  # a hole, which takes no room on disk
        with raises(FileFormatError, str(path), "bytes"):
            label_format.read(path, described.mesh, described.parts)

    def test_damage_is_read_or_refused_but_nothing_else(self, label_format: LabelFormat, tmp_path: Path) -> None:
        described = labelled_strip(20, parts_named("seat", "back"))
        path = tmp_path / f"a{label_format.suffix}"
        label_format.write(path, described)
        whole = path.read_bytes()
        rng = np.random.default_rng(11)
        for _ in range(_N_DAMAGED):
            data = bytearray(whole)
            for at in rng.integers(0, len(data), rng.integers(1, 4)):
                data[at] = rng.choice(np.frombuffer(b'0179-[]{}",:.\x00\xff\nntf e', np.uint8))
            path.write_bytes(bytes(data))
            message = ""
            try:
                found = label_format.read(path, described.mesh, described.parts)
            except PartwiseError as error:
                message = str(error)
            else:
                assert found.shape == (described.mesh.n_faces,)
            assert "\n" not in message
