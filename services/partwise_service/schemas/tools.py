"""Tools: what they are told, and their results as runs of equal numbers."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from partwise.errors import ParameterError
from partwise.segmentation.patch_parameters import PatchMethod
from partwise_service.schemas.base import WHOLE, Answer, AnyId, Request
from partwise_service.schemas.drafts import Sequence

MAX_RUNS = 200_000
MAX_FACES = 2**24
Share = Annotated[float, Field(ge=0, le=1)]
PresetName = Literal["default", "paper"]
RunLabel = Annotated[int, Field(ge=0, le=65_535), WHOLE]
RunLength = Annotated[int, Field(ge=1, le=MAX_FACES), WHOLE]
Run = Annotated[tuple[RunLabel, RunLength], Field(strict=False)]  # JSON has lists only; their items stay strict
Runs = Annotated[list[Run], Field(min_length=1, max_length=MAX_RUNS)]
"""Labels in face order as [part id, how many faces] pairs, 0 for unlabelled."""


class PatchesRequest(Request):
    """n_patches : how many; more come where the mesh has more components."""

    method: PatchMethod = "random_walks"
    n_patches: Annotated[int, Field(ge=1, le=MAX_FACES), WHOLE]


class BoundariesRequest(Request):
    """Either `runs` or `draft_id` says where to start.

    preset : how, by name; without one as section [boundary] of the workspace's partwise.toml says.
    omega : weight of angles against the change of shape diameter, in place of that of the preset or the section.
    anchor_runs, anchor_n_strokes : the labels to stay near, those that the person last set, as runs, or as the draft's
        after so many strokes; without either, those it starts from.
    """

    runs: Runs | None = None
    draft_id: AnyId | None = None
    omega: Share | None = None
    preset: PresetName | None = None
    anchor_runs: Runs | None = None
    anchor_n_strokes: Sequence | None = None


class ModelRequest(Request):
    """smoothness : λ; the one that the model's training chose without one."""

    smoothness: Annotated[float, Field(ge=0, le=1e6)] | None = None


class LabelRuns(Answer):
    """Labels of `n_faces` faces in face order as [label, how many faces] pairs."""

    mesh_hash: str
    n_faces: int
    runs: list[tuple[int, int]]


def labels_of_runs(runs: list[tuple[int, int]], n_faces: int) -> np.ndarray:
    """Labels (m,) uint16.

    Raises
    ------
    ParameterError : the runs do not cover the mesh's faces exactly.
    """
    n_covered = sum(length for _, length in runs)
    if n_covered != n_faces:
        raise ParameterError(f"runs must cover {n_faces} faces but cover {n_covered}; are they another mesh's?")
    values = np.array([label for label, _ in runs], dtype=np.uint16)
    return np.repeat(values, [length for _, length in runs])


def runs_of_labels(labels: np.ndarray) -> list[tuple[int, int]]:
    """The inverse of `labels_of_runs`."""
    starts = np.flatnonzero(np.concatenate([[True], labels[1:] != labels[:-1]]))
    lengths = np.diff(starts, append=len(labels))
    return list(zip(labels[starts].tolist(), lengths.tolist(), strict=True))
