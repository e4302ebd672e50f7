"""GLB beyond the suite: what other programs see, and files that were edited."""

import numpy as np
import pytest
import trimesh

from partwise.errors import FileFormatError, LabelError, ParameterError
from partwise.exchange.glb_parts import read_glb_parts, write_glb_parts
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh
from partwise.exchange.parts import PartEntry, PartTable
from partwise.io.glb import pack_glb, unpack_glb
from partwise.io.read import read_mesh
from partwise.io.write import write_mesh
from partwise.mesh import TriMesh

PARTS = PartTable(
    2,
    (
        PartEntry(1, "chair", "#808080"),
        PartEntry(3, "seat", "#e69f00", "where one sits", 1),
        PartEntry(4, "leg", "#0072b2", parent_id=1),
    ),
)
MESH = TriMesh(np.eye(5)[:, :3], np.array([[0, 1, 2], [1, 2, 3], [0, 3, 1], [3, 2, 1]]))  # vertex 4 is of no face
DESCRIBED = DescribedMesh(LabelledMesh(MESH, np.array([3, -1, 1, 3])), PARTS)


@pytest.fixture
def written(tmp_path):
    write_glb_parts(tmp_path / "a.glb", DESCRIBED)
    return (tmp_path / "a.glb").read_bytes()


def document(written):
    return unpack_glb(written)[0]


def edited(written, edit):
    changed, binary = unpack_glb(written)
    edit(changed)
    return pack_glb(changed, binary)


def test_there_is_a_node_for_each_part_and_for_unlabelled(written):
    nodes = document(written)["nodes"]
    assert [(node["name"], node["extras"]["part_id"], "mesh" in node) for node in nodes] == [
        ("chair", 1, True),
        ("seat", 3, True),
        ("leg", 4, False),
        ("unlabelled", -1, True),
    ]
    assert nodes[1]["extras"]["gloss"] == "where one sits"


def test_parts_hang_under_their_parents(written):
    assert document(written)["nodes"][0]["children"] == [1, 2]
    assert document(written)["scenes"][0]["nodes"] == [0, 3]


def test_there_is_no_unlabelled_node_without_need(tmp_path):
    complete = DescribedMesh(LabelledMesh(MESH, np.array([3, 4, 1, 3])), PARTS)
    write_glb_parts(tmp_path / "a.glb", complete)
    assert "unlabelled" not in {node["name"] for node in document((tmp_path / "a.glb").read_bytes())["nodes"]}


def test_other_programs_see_names_faces_and_colours(tmp_path, written):
    scene = trimesh.load(tmp_path / "a.glb")
    seen = {name: (len(part.faces), part.visual.material.baseColorFactor) for name, part in scene.geometry.items()}
    assert {name: n_faces for name, (n_faces, _) in seen.items()} == {"chair": 1, "seat": 2, "unlabelled": 1}
    linear = [((channel / 255 + 0.055) / 1.055) ** 2.4 for channel in (0xE6, 0x9F)]
    np.testing.assert_allclose(seen["seat"][1][:2] / 255, linear, atol=0.5 / 255)


def test_a_part_has_only_the_vertices_it_uses(written):
    accessors, meshes = document(written)["accessors"], document(written)["meshes"]
    counts = [accessors[mesh["primitives"][0]["attributes"]["POSITION"]]["count"] for mesh in meshes]
    assert counts == [3, 4, 3]


def test_the_mesh_reader_takes_it_part_by_part(tmp_path, written):
    mesh = read_mesh(tmp_path / "a.glb")
    assert mesh.n_faces == 4
    np.testing.assert_array_equal(mesh.vertices[mesh.faces[0]], MESH.vertices[MESH.faces[2]])


def test_coordinates_beyond_float32_are_not_written(tmp_path):
    far = TriMesh(MESH.vertices * 1e39, MESH.faces)
    with pytest.raises(ParameterError, match="float32"):
        write_glb_parts(tmp_path / "a.glb", DescribedMesh(LabelledMesh(far, DESCRIBED.labels), PARTS))
    assert not list(tmp_path.iterdir())


def test_a_glb_of_another_program_has_no_labels(tmp_path):
    write_mesh(MESH, tmp_path / "a.glb")
    with pytest.raises(FileFormatError, match=r"a\.glb: .*must say partwise\.glb 1"):
        read_glb_parts(tmp_path / "a.glb")


def _extras(**changes):
    return lambda found: found["scenes"][0]["extras"].update(changes)


def _node(index, **changes):
    return lambda found: found["nodes"][index]["extras"].update(changes)


@pytest.mark.parametrize(
    ("edit", "error", "message"),
    [
        (_extras(format_version=2), FileFormatError, "must say"),
        (_extras(n_faces=4_000_000_000), FileFormatError, "5000000 faces"),
        (_extras(n_faces=4_000_000), FileFormatError, "must fit in"),
        (_extras(n_vertices=10**15), FileFormatError, "must fit in"),
        (_extras(n_faces=-1), FileFormatError, "ValueError"),
        (_extras(n_faces="4"), FileFormatError, "TypeError"),
        (_extras(n_faces=5), FileFormatError, "each of 5 faces"),
        (_extras(n_vertices=6), FileFormatError, "finite"),
        (_extras(mesh_hash="0" * 64), LabelError, "of mesh"),
        (_extras(schema={}), FileFormatError, "the schema"),
        (_extras(provenance=7), FileFormatError, "the provenance"),
        (_node(1, part_id=7), LabelError, "has 7"),
        (_node(1, face_ids=0), FileFormatError, "place of each"),
        (_node(1, vertex_ids=99), FileFormatError, "accessor 99"),
        (lambda found: found.pop("scenes"), FileFormatError, "KeyError"),
        (lambda found: found["nodes"].append(found["nodes"][0]), FileFormatError, "have 5 faces"),
    ],
)
def test_edited_files_are_refused(written, edit, error, message):
    with pytest.raises(error, match=message) as caught:
        read_glb_parts("a.glb", edited(written, edit))
    assert str(caught.value).startswith("a.glb: ")
