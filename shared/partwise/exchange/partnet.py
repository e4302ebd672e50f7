"""PartNet: a shape in pieces, `objs/*.obj`, and a hierarchy of parts that says which pieces each part is made of.

`result.json` (as annotated) and `result_after_merging.json` (with merged semantics) are a list of nodes: `id`, `name`,
often `text`, and `children`, a list of nodes, or `objs`, a list of piece names without suffix; merged nodes may have
both, `objs` then naming the pieces of all nodes below.

The shape is the pieces that the hierarchy names, one after the other, sorted by name with numbers as numbers, so that
both files give the same mesh. A face's label is the id of the deepest node that names its piece.

Source: https://github.com/daerduoCarey/partnet_dataset (README, `scripts/merge_result_json.py`); Mo et al. 2019.
Differs: nothing.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.described_json import load_json
from partwise.exchange.label_files import read_label_text
from partwise.exchange.labelled_mesh import LabelledMesh
from partwise.exchange.named_labels import NamedLabels
from partwise.io.limits import ReadLimits
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh

HIERARCHY_FILES = ("result_after_merging.json", "result.json")
PIECES_FOLDER = "objs"
MAX_NODES = 100_000
MAX_DEPTH = 64
_PIECE_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]*")
_DIGITS = re.compile(r"(\d+)")


@dataclass(frozen=True, slots=True)
class PartNetNode:
    """A node of the hierarchy. path : the names from the root to it, so parts of one kind share it. text : for people.

    pieces : that it names itself, whether or not nodes below do too.
    """

    id: int
    path: tuple[str, ...]
    text: str
    parent_id: int | None
    pieces: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.path[-1]


@dataclass(frozen=True, slots=True, eq=False)
class PartNetShape:
    """The whole shape, its labels as node ids, and its nodes, depth first in the file's order."""

    labelled: LabelledMesh
    nodes: tuple[PartNetNode, ...]

    @property
    def mesh(self) -> TriMesh:
        return self.labelled.mesh

    @property
    def labels(self) -> Int[np.ndarray, " m"]:
        """Node id of each face, (m,) int64: an instance, such as the second of four legs."""
        return self.labelled.labels

    def named_labels(self) -> NamedLabels:
        """Labels by kind of part, under names such as `chair/chair_base/leg`; every path of the hierarchy is a name."""
        names = tuple(dict.fromkeys("/".join(node.path) for node in self.nodes))
        index_of_path = {name: k for k, name in enumerate(names)}
        ids, position = np.unique(self.labels, return_inverse=True)
        path_of_id = {node.id: "/".join(node.path) for node in self.nodes}
        indices = np.array([index_of_path[path_of_id[node_id]] for node_id in ids.tolist()], dtype=np.int64)
        return NamedLabels(names, indices[position.ravel()])


def read_partnet(folder: Path | str, hierarchy: str | None = None, limits: ReadLimits | None = None) -> PartNetShape:
    """The shape in a folder of PartNet.

    Parameters
    ----------
    hierarchy : name of the JSON file; None takes `result_after_merging.json` if there is one, else `result.json`.
    limits : for each piece's bytes and for the faces of all pieces.

    Raises
    ------
    FileFormatError : a file is missing, truncated or not as above; a piece's name leads out of its folder, or it or
        the hierarchy is a link; too many nodes, or nested too deeply; too many faces.
    LabelError : two parts claim one piece.
    """
    folder, limits = Path(folder), limits or ReadLimits()
    path = folder / (hierarchy or _hierarchy_file(folder))
    _refuse_link(path)
    try:
        nodes = parse_hierarchy(read_label_text(path, None))
        node_of_piece = _node_of_piece(nodes)
    except (FileFormatError, LabelError) as error:
        raise type(error)(str(error) if str(path) in str(error) else f"{path}: {error}") from error
    vertices: list[np.ndarray] = []
    faces: list[np.ndarray] = []
    labels: list[np.ndarray] = []
    n_vertices = n_faces = 0
    for piece in sorted(node_of_piece, key=_numbers_as_numbers):
        mesh = _read_piece(folder / PIECES_FOLDER, piece, replace(limits, max_faces=max(limits.max_faces - n_faces, 1)))
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + n_vertices)
        labels.append(np.full(mesh.n_faces, node_of_piece[piece]))
        n_vertices, n_faces = n_vertices + mesh.n_vertices, n_faces + mesh.n_faces
        limits.check_faces(n_faces)
    whole = TriMesh(np.concatenate(vertices), np.concatenate(faces))
    return PartNetShape(LabelledMesh(whole, np.concatenate(labels).astype(np.int64)), nodes)


def parse_hierarchy(text: str) -> tuple[PartNetNode, ...]:
    """The nodes of a hierarchy, depth first in the file's order; FileFormatError or LabelError as `read_partnet`."""
    document = load_json(text, "a hierarchy")
    if not isinstance(document, list) or not document:
        raise FileFormatError("a hierarchy must be a list of nodes but is not; is it another JSON file?")
    nodes: list[PartNetNode] = []
    for node in _walk(document):
        nodes.append(node)
        if len(nodes) > MAX_NODES:
            raise FileFormatError(f"a hierarchy may have {MAX_NODES} nodes but has more; is it damaged?")
    ids = {node.id for node in nodes}
    if len(ids) < len(nodes):
        raise FileFormatError(f"nodes must have ids of their own but {len(nodes)} share {len(ids)}; correct the file")
    return tuple(nodes)


def _walk(roots: list[Any]) -> Iterator[PartNetNode]:
    stack: list[tuple[Any, PartNetNode | None]] = [(root, None) for root in reversed(roots)]
    while stack:
        record, parent = stack.pop()
        node = _node(record, parent)
        yield node
        stack += [(child, node) for child in reversed(record.get("children", []))]


def _node(record: Any, parent: PartNetNode | None) -> PartNetNode:
    if not isinstance(record, dict):
        raise FileFormatError(f"a node must be an object but is {str(record)[:40]!r}; is it another JSON file?")
    node_id, name, text = record.get("id"), record.get("name"), record.get("text", "")
    pieces, children = record.get("objs", []), record.get("children", [])
    if type(node_id) is not int or node_id < 0 or not isinstance(name, str) or not name or "/" in name:
        raise FileFormatError(
            f"a node must have an id ≥ 0 and a name without slashes but has {str(node_id)[:20]}, {str(name)[:40]!r}; "
            "correct the file"
        )
    if not isinstance(text, str) or not isinstance(children, list) or not isinstance(pieces, list):
        raise FileFormatError(f"node {node_id} must have a text and lists of children and objs; correct the file")
    for piece in pieces:
        if not isinstance(piece, str) or not _PIECE_NAME.fullmatch(piece) or ".." in piece:
            raise FileFormatError(
                f"a piece must be named by letters, digits, _, - and single dots but node {node_id} names "
                f"{str(piece)[:80]!r}; do not trust the file"
            )
    path = (name,) if parent is None else (*parent.path, name)
    if len(path) > MAX_DEPTH:
        raise FileFormatError(f"a hierarchy may be {MAX_DEPTH} deep but node {node_id} is deeper; is it damaged?")
    return PartNetNode(node_id, path, text, None if parent is None else parent.id, tuple(pieces))


def _node_of_piece(nodes: tuple[PartNetNode, ...]) -> dict[str, int]:
    """Piece → id of the deepest node that names it."""
    by_id = {node.id: node for node in nodes}
    owner: dict[str, int] = {}
    for node in nodes:  # parents come before their children, so a deeper claim replaces a higher one
        for piece in dict.fromkeys(node.pieces):
            other = owner.get(piece)
            if other is not None and other not in _ancestors(node, by_id):
                raise LabelError(
                    f"a piece must be of one part but {piece} is named by node {other} ({by_id[other].name}) and node "
                    f"{node.id} ({node.name}), neither above the other; remove it from one"
                )
            owner[piece] = node.id
    if not owner:
        raise FileFormatError("a hierarchy must name pieces in objs but names none; is it another JSON file?")
    return owner


def _ancestors(node: PartNetNode, by_id: dict[int, PartNetNode]) -> Iterator[int]:
    above = node.parent_id
    while above is not None:
        yield above
        above = by_id[above].parent_id


def _read_piece(folder: Path, piece: str, limits: ReadLimits) -> TriMesh:
    path = folder / f"{piece}.obj"
    for place in (folder, path):
        _refuse_link(place)
    return read_mesh(path, limits=limits)


def _refuse_link(place: Path) -> None:
    if place.is_symlink():
        raise FileFormatError(f"{place}: what a shape is made of must be in its folder but is a link; copy it there")


def _hierarchy_file(folder: Path) -> str:
    found = next((name for name in HIERARCHY_FILES if (folder / name).is_file()), None)
    if found is None:
        raise FileFormatError(f"{folder}: a PartNet shape must have {' or '.join(HIERARCHY_FILES)} but has neither")
    return found


def _numbers_as_numbers(piece: str) -> tuple[tuple[int, str], ...]:
    return tuple((int(token), "") if token.isdecimal() else (-1, token) for token in _DIGITS.split(piece))
