"""Where a page of a list ended, as one opaque string."""

import math

from partwise.store.records import ListAnchor
from partwise_service.problems import ProblemError, ProblemKind
from partwise_service.schemas.base import MAX_ROW_ID


def cursor_of(anchor: ListAnchor) -> str:
    """The anchor as a string for `next`."""
    return str(anchor.shape_id) if anchor.value is None else f"{anchor.shape_id}~{anchor.value!r}"


def anchor_of(cursor: str | None) -> ListAnchor | None:
    """The anchor of a string that `cursor_of` made. Problem: 422 for any other."""
    if cursor is None:
        return None
    shape_id, has_value, value = cursor.partition("~")
    try:
        anchor = ListAnchor(int(shape_id), float(value) if has_value else None)
    except ValueError as error:
        raise _refused() from error
    is_finite = anchor.value is None or math.isfinite(anchor.value)
    if not 0 <= anchor.shape_id <= MAX_ROW_ID or not is_finite:
        raise _refused()
    return anchor


def _refused() -> ProblemError:
    return ProblemError(ProblemKind.INVALID, "`after` must be the `next` of the page before; leave it out to begin.")
