"""Older versions of strokes and logs made new: a chain of pure functions, each one version further.

Rows are never rewritten: what was stored under an old version is upgraded whenever it is read. To change the format,
raise `STROKE_VERSION`, add the step from the last version to both tables, and keep a golden log of that version.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from partwise.errors import FileFormatError
from partwise.labels.encoding import labels_sha256
from partwise.labels.face_runs import runs_of
from partwise.labels.stroke_fields import Fields

STROKE_VERSION = 1
_MOST_FACES = 2**24  # far above any budget, small enough to hold

Document = Mapping[str, Any]


def upgraded_stroke(document: Document) -> Document:
    """The stroke as of `STROKE_VERSION`; the given object is not changed.

    Raises
    ------
    FileFormatError : no version, a newer one, or an old stroke that is malformed.
    """
    return _upgraded(document, _STROKE_STEPS, "a stroke")


def upgraded_log(document: Document) -> Document:
    """The log's own fields as of `STROKE_VERSION`; its strokes are left as they are. Raises as `upgraded_stroke`."""
    return _upgraded(document, _LOG_STEPS, "a stroke log")


def _upgraded(document: Document, steps: Mapping[int, Callable[[Document], Document]], what: str) -> Document:
    version = Fields(document, what).whole("v")
    while version in steps:
        document = steps[version](document)
        version += 1
    if version != STROKE_VERSION:
        raise FileFormatError(
            f"{what} must have version 0 to {STROKE_VERSION} but has {version}; upgrade Partwise to read it"
        )
    return document


def _stroke_from_v0(document: Document) -> Document:
    """Version 0 had the radius in model units beside the diagonal, one seed, no angle limit, and faces one by one."""
    fields = Fields(document, "a stroke of version 0")
    new = {**document, "v": 1, "base_revision": None}
    if fields.text("kind") == "paint":
        radius, diagonal = fields.number("radius"), fields.number("diagonal")
        if not diagonal > 0:
            raise FileFormatError(f"a paint stroke of version 0 must have a diagonal above 0 but has {diagonal}")
        del new["diagonal"], new["seed"]
        new |= {
            "seeds": [fields.whole("seed")],
            "radius": min(radius / diagonal, 1.0),
            "min_cosine": None,
            "only_over": None,
        }
    elif fields.text("kind") == "assign":
        faces = fields.wholes("faces")
        if any(abs(face) > _MOST_FACES for face in faces):
            raise FileFormatError(
                f"faces must be at most {_MOST_FACES} but one is {max(faces, key=abs)}; drop the stroke"
            )
        first, count = runs_of(np.unique(np.array(faces, dtype=np.int64)))
        del new["faces"]
        new["runs"] = np.stack([first, count], axis=1).tolist()
    return new


def _log_from_v0(document: Document) -> Document:
    """Logs of version 0 always began with every face unlabelled."""
    n_faces = Fields(document, "a stroke log of version 0").whole("n_faces")
    if not 1 <= n_faces <= _MOST_FACES:
        raise FileFormatError(f"a stroke log must be of 1 to {_MOST_FACES} faces but says {n_faces}; whose log is it?")
    blank = labels_sha256(np.zeros(n_faces, dtype=np.uint16))
    return {**document, "v": 1, "base_revision": None, "base_sha256": blank}


_STROKE_STEPS: Mapping[int, Callable[[Document], Document]] = {0: _stroke_from_v0}
_LOG_STEPS: Mapping[int, Callable[[Document], Document]] = {0: _log_from_v0}
