"""The rules a per-face label array must meet before it is committed."""

import numpy as np
from jaxtyping import Integer, UInt16

from partwise.errors import LabelError
from partwise.labels.schema import MAX_PART_ID, PartSchema
from partwise.unlabelled import NO_PART_ID


def checked_labels(labels: Integer[np.ndarray, " m"], n_faces: int, schema: PartSchema) -> UInt16[np.ndarray, " m"]:
    """A uint16 copy of `labels`, one part id of `schema` or 0 (unlabelled) per face.

    Raises
    ------
    LabelError : not one-dimensional whole numbers, not one label per face, or an id that is not in the schema.
    """
    labels = np.asarray(labels)
    if labels.ndim != 1 or not np.issubdtype(labels.dtype, np.integer):
        raise LabelError(f"labels must be one whole number per face but have shape {labels.shape} of {labels.dtype}")
    if len(labels) != n_faces:
        raise LabelError(
            f"there must be one label per face but there are {len(labels)} labels for {n_faces} faces; "
            "do they belong to another mesh?"
        )
    unknown = np.setdiff1d(labels, [NO_PART_ID, *schema.ids])
    if len(unknown):
        face = int(np.flatnonzero(labels == unknown[0])[0])
        raise LabelError(
            f"face {face} has part id {unknown[0]}, which is not in schema version {schema.version} "
            f"(ids {', '.join(map(str, schema.ids)) or 'none'}; at most {MAX_PART_ID}); add the part or map the labels"
        )
    return labels.astype(np.uint16)
