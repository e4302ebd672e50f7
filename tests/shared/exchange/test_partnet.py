"""PartNet: pieces in a fixed order, labels by the deepest node, nothing read from outside the folder."""

import json

import numpy as np
import pytest

from partwise.errors import FileFormatError, LabelError
from partwise.exchange import partnet
from partwise.exchange.partnet import parse_hierarchy, read_partnet
from partwise.exchange.partnet_parts import partnet_part_table
from partwise.io.limits import ReadLimits

TRIANGLE = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\n"
HIERARCHY = [
    {
        **{"id": 0, "name": "chair", "text": "Chair"},
        "objs": ["original-2", "new-10", "new-9", "original-1"],  # merged files name all pieces again at every level
        "children": [
            {"id": 1, "name": "seat", "objs": ["original-2"]},
            {
                **{"id": 2, "name": "base", "text": "Chair Base"},
                "children": [
                    {"id": 7, "name": "leg", "text": "Leg", "objs": ["new-10"]},
                    {"id": 4, "name": "leg", "text": "Leg", "objs": ["new-9"]},
                ],
            },
        ],
    }
]


def write_shape(folder, hierarchy=HIERARCHY, name="result.json"):
    (folder / "objs").mkdir(parents=True, exist_ok=True)
    for k, (piece, n_faces) in enumerate(
        (("original-1", 1), ("original-2", 2), ("new-9", 3), ("new-10", 1), ("new-11", 1))
    ):
        (folder / "objs" / f"{piece}.obj").write_text(TRIANGLE.format(k) + "f 1 2 3\n" * n_faces)
    (folder / name).write_text(json.dumps(hierarchy))
    return folder


def with_piece(piece):
    return [{"id": 0, "name": "chair", "objs": [piece]}]


def test_pieces_come_by_name_with_numbers_as_numbers(tmp_path):
    shape = read_partnet(write_shape(tmp_path))
    assert shape.mesh.vertices[shape.mesh.faces[:, 0], 0].tolist() == [2, 2, 2, 3, 0, 1, 1]


def test_a_face_is_of_the_deepest_node_that_names_its_piece(tmp_path):
    shape = read_partnet(write_shape(tmp_path))
    assert shape.labels.tolist() == [4, 4, 4, 7, 0, 1, 1]


def test_pieces_that_no_node_names_are_no_part_of_the_shape(tmp_path):
    assert 4 not in read_partnet(write_shape(tmp_path)).mesh.vertices[:, 0]


def test_both_hierarchies_give_the_same_mesh(tmp_path):
    write_shape(tmp_path)
    merged = [{"id": 0, "name": "chair", "objs": ["new-9", "original-1", "new-10", "original-2"]}]
    (tmp_path / "result_after_merging.json").write_text(json.dumps(merged))
    raw = read_partnet(tmp_path, "result.json")
    found = read_partnet(tmp_path)
    assert found.mesh.content_hash() == raw.mesh.content_hash()
    assert set(found.labels.tolist()) == {0}


def test_nodes_know_where_they_hang(tmp_path):
    nodes = read_partnet(write_shape(tmp_path)).nodes
    assert [(node.id, node.parent_id, "/".join(node.path)) for node in nodes] == [
        (0, None, "chair"),
        (1, 0, "chair/seat"),
        (2, 0, "chair/base"),
        (7, 2, "chair/base/leg"),
        (4, 2, "chair/base/leg"),
    ]
    assert nodes[3].name == "leg"


def test_parts_of_one_kind_share_a_name(tmp_path):
    named = read_partnet(write_shape(tmp_path)).named_labels()
    assert named.part_names == ("chair", "chair/seat", "chair/base", "chair/base/leg")
    assert [named.part_names[index] for index in named.indices] == [
        *["chair/base/leg"] * 4,
        "chair",
        *["chair/seat"] * 2,
    ]


def test_a_schema_has_a_part_for_each_path_under_its_parent(tmp_path):
    nodes = read_partnet(write_shape(tmp_path)).nodes
    table = partnet_part_table([nodes])
    assert [(part.id, part.name, part.parent_id, part.gloss) for part in table.parts] == [
        (1, "chair", None, "Chair"),
        (2, "chair/base", 1, "Chair Base"),
        (3, "chair/base/leg", 2, "Leg"),
        (4, "chair/seat", 1, ""),
    ]


def test_a_schema_does_not_depend_on_the_order_of_shapes():
    one = parse_hierarchy(json.dumps(HIERARCHY))
    other = parse_hierarchy(json.dumps([{"id": 3, "name": "chair", "text": "A Chair", "objs": ["a"]}]))
    assert partnet_part_table([one, other]) == partnet_part_table([other, one])


@pytest.mark.parametrize(
    "piece",
    ["../x", "/etc/passwd", "a/b", "a\\b", "..", ".hidden", "a..b", "a\x00", "", "C:x", "a b", "new-1\n", 7, None],
)
def test_names_that_lead_elsewhere_are_refused(tmp_path, piece):
    with pytest.raises(FileFormatError, match="do not trust") as caught:
        read_partnet(write_shape(tmp_path, with_piece(piece)))
    assert "\n" not in str(caught.value)


def test_a_piece_that_is_a_link_is_refused(tmp_path):
    write_shape(tmp_path / "a", with_piece("linked"))
    (tmp_path / "a/objs/linked.obj").symlink_to(tmp_path / "a/objs/new-9.obj")
    with pytest.raises(FileFormatError, match="is a link"):
        read_partnet(tmp_path / "a")


def test_a_hierarchy_that_is_a_link_is_refused(tmp_path):
    write_shape(tmp_path / "a")
    (tmp_path / "a/result.json").rename(tmp_path / "elsewhere.json")
    (tmp_path / "a/result.json").symlink_to(tmp_path / "elsewhere.json")
    with pytest.raises(FileFormatError, match="is a link"):
        read_partnet(tmp_path / "a")


def test_a_folder_of_pieces_that_is_a_link_is_refused(tmp_path):
    write_shape(tmp_path / "a")
    (tmp_path / "b").mkdir()
    (tmp_path / "b/objs").symlink_to(tmp_path / "a/objs")
    (tmp_path / "b/result.json").write_text(json.dumps(HIERARCHY))
    with pytest.raises(FileFormatError, match="is a link"):
        read_partnet(tmp_path / "b")


def test_two_parts_that_claim_one_piece_are_refused(tmp_path):
    nodes = [{"id": 0, "name": "a", "objs": ["new-9"]}, {"id": 1, "name": "b", "objs": ["new-9"]}]
    with pytest.raises(LabelError, match=r"result\.json: .*new-9 is named by node 0 \(a\) and node 1 \(b\)"):
        read_partnet(write_shape(tmp_path, nodes))


def deep(n_levels):
    node = {"id": n_levels, "name": "x", "objs": ["new-9"]}
    for k in range(n_levels):
        node = {"id": k, "name": "x", "children": [node]}
    return [node]


@pytest.mark.parametrize(
    ("hierarchy", "message"),
    [
        ({}, "list of nodes"),
        ([], "list of nodes"),
        ([7], "must be an object"),
        ([{"name": "x"}], "id ≥ 0"),
        ([{"id": -1, "name": "x"}], "id ≥ 0"),
        ([{"id": True, "name": "x"}], "id ≥ 0"),
        ([{"id": 0}], "a name"),
        ([{"id": 0, "name": "a/b"}], "without slashes"),
        ([{"id": 0, "name": "x", "text": 7}], "lists of children"),
        ([{"id": 0, "name": "x", "children": {}}], "lists of children"),
        ([{"id": 0, "name": "x", "objs": "new-9"}], "lists of children"),
        ([{"id": 0, "name": "x"}, {"id": 0, "name": "y"}], "ids of their own"),
        ([{"id": 0, "name": "x"}], "names none"),
        (deep(70), "64 deep"),
    ],
)
def test_what_is_no_hierarchy(tmp_path, hierarchy, message):
    with pytest.raises(FileFormatError, match=message) as caught:
        read_partnet(write_shape(tmp_path, hierarchy))
    assert str(caught.value).startswith(str(tmp_path / "result.json"))


def test_too_many_nodes(monkeypatch):
    monkeypatch.setattr(partnet, "MAX_NODES", 100)
    nodes = [{"id": k, "name": "x", "objs": []} for k in range(101)]
    with pytest.raises(FileFormatError, match="100 nodes"):
        parse_hierarchy(json.dumps(nodes))


def test_a_truncated_hierarchy(tmp_path):
    write_shape(tmp_path)
    path = tmp_path / "result.json"
    path.write_text(path.read_text()[:100])
    with pytest.raises(FileFormatError, match=r"result\.json: .*must be JSON"):
        read_partnet(tmp_path)


def test_no_hierarchy(tmp_path):
    with pytest.raises(FileFormatError, match="has neither"):
        read_partnet(tmp_path)


def test_a_missing_piece(tmp_path):
    with pytest.raises(FileFormatError, match=r"nowhere\.obj: .*No such file"):
        read_partnet(write_shape(tmp_path, with_piece("nowhere")))


def test_faces_of_all_pieces_count_together(tmp_path):
    write_shape(tmp_path)
    assert read_partnet(tmp_path, limits=ReadLimits(max_faces=7)).mesh.n_faces == 7
    with pytest.raises(FileFormatError, match="faces"):
        read_partnet(tmp_path, limits=ReadLimits(max_faces=6))


def test_labels_are_node_ids_of_whole_numbers(tmp_path):
    assert read_partnet(write_shape(tmp_path)).labels.dtype == np.int64
