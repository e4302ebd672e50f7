"""The state of a shape: derived, in this one place, from its revisions and stage runs, never stored.

In order, the first that holds: review (an open review: its newest human or imported labels wait for someone to look at
them), confirmed (a human or imported revision), ready (the describe stage has a current done
run), failed (any stage failed), new. See `partwise.store.records.ShapeState`.
"""

from sqlalchemy import ColumnElement, and_, case, exists, false, literal_column

from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import RunStatus, ShapeState

READY_STAGE = "describe"
"""The stage that makes a shape ready: what it leaves behind is all that prediction and annotation need."""

# written out, not bound: a partial index serves only a query whose text repeats the index's condition
_DONE: ColumnElement[str] = literal_column(f"'{RunStatus.DONE}'")
_FAILED: ColumnElement[str] = literal_column(f"'{RunStatus.FAILED}'")


def is_current_run() -> ColumnElement[bool]:
    """Done and not superseded: at most one row for a shape and a stage."""
    return and_(t.stage_run.c.status == _DONE, t.stage_run.c.is_superseded == false())


def is_failed_run() -> ColumnElement[bool]:
    return t.stage_run.c.status == _FAILED


def shape_state() -> ColumnElement[str]:
    """The state of the row of `shape` in the surrounding query."""
    is_in_review = exists().where(t.review.c.shape_id == t.shape.c.id, t.review.c.resolved_at.is_(None))
    is_confirmed = exists().where(
        t.label_revision.c.shape_id == t.shape.c.id, t.label_revision.c.kind.in_([kind.value for kind in SHOWN_KINDS])
    )
    of_shape = t.stage_run.c.shape_id == t.shape.c.id
    is_ready = exists().where(of_shape, t.stage_run.c.stage == READY_STAGE, is_current_run())
    is_failed = exists().where(of_shape, is_failed_run())
    return case(
        (is_in_review.correlate(t.shape), ShapeState.REVIEW.value),
        (is_confirmed.correlate(t.shape), ShapeState.CONFIRMED.value),
        (is_ready.correlate(t.shape), ShapeState.READY.value),
        (is_failed.correlate(t.shape), ShapeState.FAILED.value),
        else_=ShapeState.NEW.value,
    )
