"""What people choose between by name. Loads nothing heavy, so that a command line can offer it at once."""

from enum import StrEnum


class Segmentation(StrEnum):
    """Which labels of a shape are meant."""

    CONFIRMED = "confirmed"
    REFINED = "refined"
    PREDICTED = "predicted"


class ExportFormat(StrEnum):
    """seg : a text file of one part id per line, in face order. ply : the mesh with face colours and part ids."""

    SEG = "seg"
    PLY = "ply"


class ScoreName(StrEnum):
    """Acquisition scores on record: mean entropy over faces (George et al. 2018), and over area."""

    ENTROPY = "entropy"
    ENTROPY_BY_AREA = "entropy_by_area"
