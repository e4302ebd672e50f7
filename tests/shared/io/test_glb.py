"""GLB: scenes flattened in document order, whatever way their arrays are laid out."""

import base64
import json
import struct

import numpy as np
import pytest
import trimesh

from partwise.errors import FileFormatError
from partwise.io.glb import format_glb, parse_glb
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype="<f4")
FACES = np.array([[0, 1, 2], [0, 2, 3]], dtype="<u2")


def pack(document, binary=b""):
    text = json.dumps(document).encode() if isinstance(document, dict) else document
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def document(**changes):
    """A square of two triangles in one node."""
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60}],
        **changes,
    }


BINARY = POINTS.tobytes() + FACES.tobytes()


def read(doc, binary=BINARY, limits=None):
    return parse_glb(pack(doc, binary), limits or ReadLimits())


def test_a_square():
    mesh = read(document())
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, FACES)


def test_nodes_come_depth_first_in_document_order():
    nodes = [
        {"children": [2, 1], "translation": [10, 0, 0]},
        {"mesh": 0, "translation": [0, 100, 0]},
        {"mesh": 0, "translation": [0, 200, 0], "children": [3]},
        {"mesh": 0, "translation": [0, 0, 5]},
        {"mesh": 0},
    ]
    mesh = read(document(nodes=nodes, scenes=[{"nodes": [4, 0]}]))
    first_corners = mesh.vertices[mesh.faces[::2, 0]]
    np.testing.assert_array_equal(first_corners, [[0, 0, 0], [10, 200, 0], [10, 200, 5], [10, 100, 0]])


def test_primitives_come_in_order_and_lines_are_left_out():
    primitives = [
        {"attributes": {"POSITION": 0}, "indices": 1, "mode": 1},
        {"attributes": {"POSITION": 0}, "indices": 2},
        {"attributes": {"POSITION": 0}, "indices": 1},
    ]
    doc = document(meshes=[{"primitives": primitives}])
    doc["accessors"].append({"bufferView": 1, "byteOffset": 6, "componentType": 5123, "count": 3, "type": "SCALAR"})
    np.testing.assert_array_equal(read(doc).vertices[read(doc).faces], POINTS[[[0, 2, 3], [0, 1, 2], [0, 2, 3]]])


def test_only_the_default_scene_is_read():
    nodes = [{"mesh": 0}, {"mesh": 0, "translation": [7, 0, 0]}]
    mesh = read(document(nodes=nodes, scenes=[{"nodes": [0]}, {"nodes": [1]}], scene=1))
    np.testing.assert_array_equal(mesh.vertices, POINTS + np.array([7, 0, 0]))


def test_without_scenes_the_roots_are_read():
    doc = document(nodes=[{"mesh": 0}, {"children": [0], "scale": [2, 2, 2]}])
    del doc["scenes"]
    np.testing.assert_array_equal(read(doc).vertices, POINTS * 2)


def test_without_nodes_the_meshes_are_read():
    np.testing.assert_array_equal(read(document(nodes=[])).faces, FACES)


def test_rotation_scale_and_translation_equal_their_matrix():
    half = np.sqrt(0.5)
    parts = {"translation": [1, 2, 3], "rotation": [0, 0, half, half], "scale": [2, 3, 4]}
    quarter_turn = [[0, -3, 0, 1], [2, 0, 0, 2], [0, 0, 4, 3], [0, 0, 0, 1]]
    matrix = {"matrix": np.array(quarter_turn, dtype=float).T.ravel().tolist()}
    by_parts, by_matrix = (read(document(nodes=[{"mesh": 0, **node}])) for node in (parts, matrix))
    np.testing.assert_allclose(by_parts.vertices, by_matrix.vertices, atol=1e-12)


def test_a_mirroring_node_turns_the_winding():
    mesh = read(document(nodes=[{"mesh": 0, "scale": [-1, 1, 1]}]))
    np.testing.assert_array_equal(mesh.faces, FACES[:, [0, 2, 1]])


def test_seams_are_welded():
    doc = document(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}],
        accessors=[{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"}],
        bufferViews=[{"buffer": 0, "byteLength": 72}],
    )
    mesh = read(doc, POINTS[FACES].tobytes())
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, FACES)


@pytest.mark.parametrize(
    ("mode", "corners", "expected"),
    [
        (5, [0, 1, 2, 3], [[0, 1, 2], [1, 3, 2]]),
        (6, [0, 1, 2, 3], [[1, 2, 0], [2, 3, 0]]),
        (5, [0, 1], None),
    ],
)
def test_strips_and_fans(mode, corners, expected):
    doc = document(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": mode}]}])
    doc["accessors"][1]["count"] = len(corners)
    binary = POINTS.tobytes() + np.array(corners, dtype="<u2").tobytes().ljust(12, b"\0")
    if expected is None:
        with pytest.raises(FileFormatError, match="has 0"):
            read(doc, binary)
    else:
        np.testing.assert_array_equal(read(doc, binary).faces, expected)


def test_interleaved_vertices():
    rows = np.concatenate([np.full((4, 1), 9, dtype="<f4"), POINTS, np.full((4, 2), 9, dtype="<f4")], axis=1)
    doc = document(
        bufferViews=[
            {"buffer": 0, "byteLength": 96, "byteStride": 24},
            {"buffer": 0, "byteOffset": 96, "byteLength": 12},
        ]
    )
    doc["accessors"][0]["byteOffset"] = 4
    np.testing.assert_array_equal(read(doc, rows.tobytes() + FACES.tobytes()).vertices, POINTS)


def test_quantised_positions():
    doc = document()
    doc["accessors"][0] |= {"componentType": 5120, "normalized": True}
    doc["bufferViews"][0]["byteStride"] = 4
    binary = np.pad((POINTS * 127).astype("i1"), ((0, 0), (0, 1))).tobytes().ljust(48, b"\0") + FACES.tobytes()
    np.testing.assert_array_equal(read(doc, binary).vertices, POINTS)


def test_sparse_positions():
    doc = document()
    doc["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 3},
    }
    doc["bufferViews"] += [
        {"buffer": 0, "byteOffset": 60, "byteLength": 1},
        {"buffer": 0, "byteOffset": 64, "byteLength": 12},
    ]
    binary = BINARY + b"\x02\0\0\0" + np.array([5, 6, 7], dtype="<f4").tobytes()
    np.testing.assert_array_equal(read(doc, binary).vertices, [[0, 0, 0], [1, 0, 0], [5, 6, 7], [0, 1, 0]])
    with pytest.raises(FileFormatError, match="row 4 of 4"):
        read(doc, binary.replace(b"\x02\0\0\0\0\0\xa0", b"\x04\0\0\0\0\0\xa0"))


def test_an_embedded_buffer():
    uri = "data:application/octet-stream;base64," + base64.b64encode(BINARY).decode()
    doc = document(buffers=[{"byteLength": 60, "uri": uri}])
    np.testing.assert_array_equal(read(doc, b"").faces, FACES)


def edited(path, value):
    doc = json.loads(json.dumps(document()))
    target = doc
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    return doc


INDICES_IN_POSITIONS = {"bufferView": 0, "byteOffset": 12, "componentType": 5123, "count": 6, "type": "SCALAR"}
DRACO = {"KHR_draco_mesh_compression": {}}


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (["accessors", 0, "count"], 5, "truncated"),
        (["accessors", 0, "count"], -1, "count records"),
        (["accessors", 0, "count"], 10**6, "truncated"),
        (["accessors", 0, "componentType"], 5130, "glTF 2.0"),
        (["accessors", 0, "type"], "VEC2", "3 columns"),
        (["accessors", 0], {"componentType": 5126, "count": 4, "type": "VEC3"}, "must have data"),
        (["accessors", 1, "count"], 5, "3 corners each"),
        (["accessors", 1], INDICES_IN_POSITIONS, "index"),
        (["bufferViews", 0, "byteStride"], 4, "truncated"),
        (["bufferViews", 0, "byteOffset"], -4, "truncated"),
        (["bufferViews", 0, "extensions"], {"EXT_meshopt_compression": {}}, "meshopt"),
        (["bufferViews", 0, "buffer"], 3, "glTF 2.0"),
        (["buffers", 0, "uri"], "other.bin", "self-contained"),
        (["buffers", 0, "uri"], "data:;base64,*", "base64"),
        (["meshes", 0, "primitives", 0, "indices"], 9, "accessor 9"),
        (["meshes", 0, "primitives", 0, "extensions"], DRACO, "Draco"),
        (["meshes", 0, "primitives", 0, "attributes"], {}, "POSITION"),
        (["meshes", 0, "primitives", 0, "mode"], 0, "must have triangles"),
        (["nodes", 0, "children"], [0], "tree"),
        (["nodes", 0, "children"], [8], "tree"),
        (["nodes", 0, "rotation"], [0, 0, 1], "4 numbers"),
        (["nodes", 0, "matrix"], [1, 2, 3], "16 numbers"),
        (["nodes", 0, "translation"], [float("inf"), 0, 0], "3 numbers"),
        (["nodes", 0, "scale"], [1e30, 0, 0], "3 numbers below"),
        (["nodes", 0, "scale"], ["a", 1, 1], "must be numbers"),
        (["scenes"], [], "glTF 2.0"),
        (["scenes", 0, "nodes"], [], "must have triangles"),
        (["meshes"], {"a": 1}, "glTF 2.0"),
    ],
)
def test_refuses_documents(path, value, message):
    with pytest.raises(FileFormatError, match=message):
        read(edited(path, value))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"gltf" + pack(document(), BINARY)[4:], "must start with glTF"),
        (pack(document(), BINARY).replace(b"\x02\0\0\0", b"\x01\0\0\0", 1), "version 2"),
        (pack(document(), BINARY)[:-1], "truncated"),
        (pack(b"{", BINARY), "JSON"),
        (pack(b"[]", BINARY), "object"),
        (pack(b"[" * 200_000, BINARY), "JSON"),
        (b"glTF" + struct.pack("<II", 2, 12), "JSON"),
        (b"glTF" + struct.pack("<IIII", 2, 20, 999, 0x4E4F534A), "chunk promises 999"),
    ],
)
def test_refuses_containers(data, message):
    with pytest.raises(FileFormatError, match=message):
        parse_glb(data, ReadLimits())


def test_instances_count_against_the_limit():
    nodes = [{"mesh": 0}] * 4
    with pytest.raises(FileFormatError, match="max_faces"):
        read(document(nodes=nodes, scenes=[{"nodes": [0, 1, 2, 3]}]), limits=ReadLimits(max_faces=7))


def test_vertices_of_instances_count_against_the_limit():
    doc = document(nodes=[{"mesh": 0}] * 2, scenes=[{"nodes": [0, 1]}])
    doc["accessors"][1]["count"] = 3
    with pytest.raises(FileFormatError, match="can use 6 vertices"):
        read(doc, limits=ReadLimits(max_faces=2))


def test_trimesh_reads_what_is_written():
    mesh = TriMesh(POINTS, FACES.astype(np.int64))
    scene = trimesh.load_scene(trimesh.util.wrap_as_stream(format_glb(mesh)), file_type="glb", process=False)
    np.testing.assert_array_equal(scene.to_geometry().faces, FACES)


def test_trimesh_reads_the_colours():
    colours = np.array([[255, 0, 0], [0, 0, 255]], dtype=np.uint8)
    data = format_glb(TriMesh(POINTS, FACES.astype(np.int64)), colours)
    scene = trimesh.load_scene(trimesh.util.wrap_as_stream(data), file_type="glb", process=False)
    np.testing.assert_array_equal(scene.to_geometry().visual.face_colors[:, :3], colours)


def test_trimesh_scene_with_transforms_has_the_same_triangles():
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3], [4, 5, 6])
    scene.add_geometry(trimesh.creation.box(), node_name="a", transform=turn)
    scene.add_geometry(trimesh.creation.icosphere(subdivisions=1), node_name="b", parent_node_name="a", transform=turn)
    data = scene.export(file_type="glb")
    mesh = parse_glb(data, ReadLimits())
    expected = trimesh.load_scene(trimesh.util.wrap_as_stream(data), file_type="glb", process=False).to_geometry()
    ours, theirs = (np.sort(t.reshape(-1, 9).round(6), axis=0) for t in (mesh.vertices[mesh.faces], expected.triangles))
    np.testing.assert_allclose(ours, theirs, atol=1e-5)
