"""COCO-style JSON: one file for a collection; shapes are its images, faces its pixels, parts its categories.

An image is one pixel high and as many wide as its mesh has faces; an annotation marks the faces of one part with
uncompressed run lengths, `{"size": [1, n_faces], "counts": […]}`, in face order. COCO's own tools take it as it is.
Faces in no annotation are unlabelled; a part without faces has a category and no annotation. Added to COCO's fields: of
images `mesh_hash`, `n_faces` and `provenance`; of categories `colour`, `gloss` and `parent_id` (`supercategory` is the
parent's name, "" at the top); of annotations `area_share`, the part's share of the surface, while `area` counts faces
as COCO counts pixels; of `info` the format and the schema's version.

Source: Lin et al. 2014 and https://cocodataset.org/#format-data. Differs: as above; `iscrowd` is 0, because 1 would
have the evaluation leave the part out.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError, LabelError, ParameterError, PartwiseError
from partwise.exchange.described_json import load_json, provenance_document, provenance_from_document
from partwise.exchange.label_files import read_label_text
from partwise.exchange.labelled_mesh import DescribedMesh, Provenance, check_mesh_hash, check_sha256
from partwise.exchange.parts import PartEntry, PartTable
from partwise.exchange.run_lengths import mask_of, run_lengths
from partwise.geometry.faces import face_areas
from partwise.io.atomic import write_atomically
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh
from partwise.unlabelled import NO_CLASS

FORMAT, FORMAT_VERSION = "partwise.coco", 1


@dataclass(frozen=True, slots=True, eq=False)
class CocoPart:
    """The faces of one part of a shape. runs : (r,) int64, see `run_lengths`. area_share : of the surface, 0 to 1."""

    part_id: int
    runs: Int[np.ndarray, " r"]
    area_share: float


@dataclass(frozen=True, slots=True, eq=False)
class CocoShape:
    """A shape's labels as run lengths, without its mesh.

    Raises
    ------
    LabelError : runs that do not cover the faces, or overlap.
    ParameterError : no name, no hash.
    FileFormatError : as many faces as no mesh may have.
    """

    name: str
    mesh_hash: str
    n_faces: int
    parts: tuple[CocoPart, ...]
    provenance: Provenance | None = None

    def __post_init__(self) -> None:
        if not self.name or self.n_faces < 1:
            raise ParameterError(f"a shape must have a name and faces but is {self.name!r} with {self.n_faces}")
        ReadLimits().check_faces(self.n_faces)
        check_sha256(self.mesh_hash, f"mesh_hash of {self.name}")
        is_taken = np.zeros(self.n_faces, dtype=bool)
        for part in self.parts:
            if len(part.runs) < 2 or int(part.runs.min()) < 0 or int(part.runs.max()) > self.n_faces:
                raise LabelError(
                    f"runs of part {part.part_id} of {self.name} must be two or more numbers from 0 to its "
                    f"{self.n_faces} faces but are {str(part.runs.tolist())[:60]}; leave out parts without faces"
                )
            if int(part.runs.sum()) != self.n_faces:
                raise LabelError(
                    f"runs of part {part.part_id} of {self.name} must cover its {self.n_faces} faces but cover "
                    f"{int(part.runs.sum())}; do the labels belong to another mesh?"
                )
            mask = mask_of(part.runs)
            if (is_taken & mask).any():
                face = int(np.argmax(is_taken & mask))
                raise LabelError(f"a face must have one part but face {face} of {self.name} has two; remove one")
            is_taken |= mask

    def labels(self) -> Int[np.ndarray, " m"]:
        """Part id of each face, (m,) int64; −1 = unlabelled."""
        labels = np.full(self.n_faces, NO_CLASS, dtype=np.int64)
        for part in self.parts:
            labels[mask_of(part.runs)] = part.part_id
        return labels

    def labels_on(self, mesh: TriMesh) -> Int[np.ndarray, " m"]:
        """The same, for the mesh they belong to; LabelError if `mesh` is another."""
        check_mesh_hash(mesh.content_hash(), self.mesh_hash)
        return self.labels()


@dataclass(frozen=True, slots=True, eq=False)
class CocoDataset:
    """Shapes labelled under one schema.

    Raises
    ------
    LabelError : a shape has a part that the schema lacks.
    """

    parts: PartTable
    shapes: tuple[CocoShape, ...]

    def __post_init__(self) -> None:
        for shape in self.shapes:
            self.parts.check_labels(np.array([part.part_id for part in shape.parts], dtype=np.int64))


def coco_shape(name: str, described: DescribedMesh) -> CocoShape:
    """A shape's labels as run lengths, by part id, parts with faces only; the mesh may be let go of afterwards."""
    areas = face_areas(described.mesh)
    total = float(areas.sum())
    parts = []
    for part_id in np.unique(described.labels[described.labels != NO_CLASS]).tolist():
        mask = described.labels == part_id
        share = float(areas[mask].sum()) / total if total > 0 else 0.0
        parts.append(CocoPart(part_id, run_lengths(mask), round(share, 9)))
    return CocoShape(name, described.mesh.content_hash(), described.mesh.n_faces, tuple(parts), described.provenance)


def write_coco(path: Path | str, dataset: CocoDataset) -> None:
    """Writes the collection's file, about 10 bytes for each run; StoreError if it cannot be written."""
    name_of = {part.id: part.name for part in dataset.parts.parts}
    document = {
        "info": {
            "description": "part labels of mesh faces",
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "schema_version": dataset.parts.version,
        },
        "licenses": [],
        "images": [_image(k, shape) for k, shape in enumerate(dataset.shapes, start=1)],
        "categories": [_category(part, name_of) for part in dataset.parts.parts],
        "annotations": _annotations(dataset.shapes),
    }
    write_atomically(path, (json.dumps(document, ensure_ascii=False, separators=(",", ":")) + "\n").encode())


def read_coco(path: Path | str, data: bytes | None = None) -> CocoDataset:
    """What `write_coco` wrote.

    Raises
    ------
    FileFormatError : not JSON, truncated, another format, or references to what is not there.
    LabelError : runs that do not fit the faces.
    """
    text = read_label_text(path, data)
    try:
        document = load_json(text, "a COCO file")
        info = document["info"]
        if (info.get("format"), info.get("format_version")) != (FORMAT, FORMAT_VERSION):
            raise FileFormatError(
                f"a COCO file of faces must say {FORMAT} {FORMAT_VERSION} in its info but says "
                f"{str(info.get('format'))[:40]!r}; images of pixels cannot be read as faces"
            )
        parts = PartTable(info["schema_version"], tuple(_part(category) for category in document["categories"]))
        parts_of: dict[int, list[CocoPart]] = {image["id"]: [] for image in document["images"]}
        if len(parts_of) < len(document["images"]):
            raise FileFormatError("images must have ids of their own but one comes twice; export the file again")
        for annotation in document["annotations"]:
            parts_of[annotation["image_id"]].append(_coco_part(annotation))
        shapes = (_shape(image, parts_of[image["id"]]) for image in document["images"])
        return CocoDataset(parts, tuple(shapes))
    except LabelError as error:
        raise LabelError(f"{path}: {error}") from error
    except PartwiseError as error:
        raise FileFormatError(f"{path}: {error}") from error
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise FileFormatError(
            f"{path}: it must be as Partwise writes it but {type(error).__name__} {error} came up; export again"
        ) from error


def _image(image_id: int, shape: CocoShape) -> dict[str, Any]:
    return {
        **{"id": image_id, "file_name": shape.name, "width": shape.n_faces, "height": 1},
        **{"n_faces": shape.n_faces, "mesh_hash": shape.mesh_hash},
        "provenance": provenance_document(shape.provenance),
    }


def _category(part: PartEntry, name_of: dict[int, str]) -> dict[str, Any]:
    return {
        **{"id": part.id, "name": part.name},
        "supercategory": "" if part.parent_id is None else name_of[part.parent_id],
        **{"colour": part.colour, "gloss": part.gloss, "parent_id": part.parent_id},
    }


def _annotations(shapes: tuple[CocoShape, ...]) -> list[dict[str, Any]]:
    marked = [(k, shape.n_faces, part) for k, shape in enumerate(shapes, start=1) for part in shape.parts]
    return [
        {
            **{"id": annotation_id, "image_id": image_id, "category_id": part.part_id, "iscrowd": 0},
            "segmentation": {"size": [1, n_faces], "counts": part.runs.tolist()},
            **{"area": int(part.runs[1::2].sum()), "area_share": part.area_share, "bbox": _bounding_box(part.runs)},
        }
        for annotation_id, (image_id, n_faces, part) in enumerate(marked, start=1)
    ]


def _bounding_box(runs: Int[np.ndarray, " r"]) -> list[int]:
    """x, y, width and height of the marked pixels."""
    first, last = int(runs[0]), int(runs[: len(runs) // 2 * 2].sum())
    return [first, 0, last - first, 1]


def _part(category: dict[str, Any]) -> PartEntry:
    return PartEntry(category["id"], category["name"], category["colour"], category["gloss"], category["parent_id"])


def _coco_part(annotation: dict[str, Any]) -> CocoPart:
    counts = annotation["segmentation"]["counts"]
    if not all(type(count) is int for count in counts):
        raise FileFormatError("run lengths must be whole numbers but one is not; decompress the file's masks")
    return CocoPart(int(annotation["category_id"]), np.array(counts, dtype=np.int64), float(annotation["area_share"]))


def _shape(image: dict[str, Any], parts: list[CocoPart]) -> CocoShape:
    return CocoShape(
        image["file_name"],
        image["mesh_hash"],
        int(image["n_faces"]),
        tuple(parts),
        provenance_from_document(image["provenance"]),
    )
