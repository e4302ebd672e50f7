"""What people choose between by name. Loads nothing heavy, so that a command line can offer it at once."""

from dataclasses import dataclass
from enum import StrEnum


class Segmentation(StrEnum):
    """Which labels of a shape are meant."""

    CONFIRMED = "confirmed"
    REFINED = "refined"
    PREDICTED = "predicted"


class ExportFormat(StrEnum):
    """seg : a text file of one part id per line, in face order. ply : the mesh with face colours and part ids.
    glb : the mesh with a node for each part. npz : numpy arrays. shapenetpart : points with normals and part ids.
    coco : one JSON file for all shapes. See docs/formats.md.
    """

    SEG = "seg"
    PLY = "ply"
    GLB = "glb"
    NPZ = "npz"
    SHAPENETPART = "shapenetpart"
    COCO = "coco"


@dataclass(frozen=True, slots=True)
class PointSampling:
    """Points drawn of each shape for ShapeNetPart; with `omit_unlabelled`, on labelled faces only."""

    n_points: int = 2_500
    seed: int = 0
    omit_unlabelled: bool = False


class ScoreName(StrEnum):
    """Acquisition scores on record: mean entropy over faces (George et al. 2018), and over area."""

    ENTROPY = "entropy"
    ENTROPY_BY_AREA = "entropy_by_area"
