"""A mesh with a label on every face, and the same with all that says what the labels mean and where they are from."""

import re
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from partwise.errors import LabelError, ParameterError
from partwise.exchange.parts import PartTable
from partwise.mesh import TriMesh

LABEL_KINDS = ("human", "imported", "reference", "predicted", "refined")
_SHA256 = re.compile(r"[0-9a-f]{64}")


def check_sha256(value: str, what: str) -> None:
    """Raises ParameterError unless `value` is a SHA-256 in lower-case hex."""
    if not _SHA256.fullmatch(value):
        raise ParameterError(f"{what} must be SHA-256 in lower-case hex but is {value!r}; compute it from the bytes")


def check_mesh_hash(mesh_hash: str, promised: str) -> None:
    """Raises LabelError where a mesh is not the one that labels were made on."""
    if mesh_hash != promised:
        raise LabelError(
            f"labels must be those of the mesh but are of mesh {promised[:12]}… and this is {mesh_hash[:12]}…; "
            "export again from the mesh they belong to"
        )


@dataclass(frozen=True, slots=True, eq=False)
class LabelledMesh:
    """A mesh and the label of each of its faces, (m,) int64; −1 = unlabelled.

    Raises
    ------
    LabelError : not one label per face.
    """

    mesh: TriMesh
    labels: Int[np.ndarray, " m"]

    def __post_init__(self) -> None:
        if self.labels.shape != (self.mesh.n_faces,):
            raise LabelError(
                f"{self.mesh.n_faces} faces must have a label each but labels are {self.labels.shape}; another mesh's?"
            )

    def labels_on(self, mesh: TriMesh) -> Int[np.ndarray, " m"]:
        """The labels, for the mesh they belong to; LabelError if `mesh` is another."""
        check_mesh_hash(mesh.content_hash(), self.mesh.content_hash())
        return self.labels


@dataclass(frozen=True, slots=True)
class Provenance:
    """Where a shape's labels are from.

    source_key : the shape's name in its collection. source_hash : SHA-256 of the ingested file.
    kind : one of `LABEL_KINDS`. model_version : the model of predicted and refined labels; None for others.

    Raises
    ------
    ParameterError : no hash, an unknown kind, or a model where there is none and the other way round.
    """

    source_key: str
    source_hash: str
    kind: str
    model_version: int | None
    partwise_version: str

    def __post_init__(self) -> None:
        check_sha256(self.source_hash, f"source_hash of {self.source_key}")
        if self.kind not in LABEL_KINDS:
            raise ParameterError(f"the kind of labels must be one of {LABEL_KINDS} but is {self.kind!r}; choose one")
        if (self.model_version is not None) != (self.kind in ("predicted", "refined")):
            raise ParameterError(
                f"predicted and refined labels must name their model, others none, but {self.source_key} has "
                f"{self.kind} labels of model {self.model_version}"
            )


@dataclass(frozen=True, slots=True, eq=False)
class DescribedMesh:
    """A labelled mesh, the schema its labels are ids of, and where they are from, if that is known.

    Raises
    ------
    LabelError : a label is neither −1 nor a part's id.
    """

    labelled: LabelledMesh
    parts: PartTable
    provenance: Provenance | None = None

    def __post_init__(self) -> None:
        self.parts.check_labels(self.labelled.labels)

    @property
    def mesh(self) -> TriMesh:
        return self.labelled.mesh

    @property
    def labels(self) -> Int[np.ndarray, " m"]:
        return self.labelled.labels
