"""The catalog's tables as SQLAlchemy Core sees them. The migrations make them; a test checks that the two agree."""

from partwise.store.tables.accepts import accept_batch, recheck
from partwise.store.tables.base import UtcDateTime, metadata
from partwise.store.tables.collections import audit, collection, part, person
from partwise.store.tables.drafts import answer, blind_check, consensus, draft, stroke
from partwise.store.tables.jobs import event, job, training_tally, worker
from partwise.store.tables.labels import label_part, label_revision, review
from partwise.store.tables.leases import honeypot, lease, queue_rank
from partwise.store.tables.listing import head_part, ordering, ordering_row, shape_facet
from partwise.store.tables.models import embedding, first_shape, model, ranking, score, score_tally
from partwise.store.tables.shapes import block, mesh, shape, shape_mesh, stage_run
from partwise.store.tables.tokens import login_code, token

__all__ = [
    "UtcDateTime",
    "accept_batch",
    "answer",
    "audit",
    "blind_check",
    "block",
    "collection",
    "consensus",
    "draft",
    "embedding",
    "event",
    "first_shape",
    "head_part",
    "honeypot",
    "job",
    "label_part",
    "label_revision",
    "lease",
    "login_code",
    "mesh",
    "metadata",
    "model",
    "ordering",
    "ordering_row",
    "part",
    "person",
    "queue_rank",
    "ranking",
    "recheck",
    "review",
    "score",
    "score_tally",
    "shape",
    "shape_facet",
    "shape_mesh",
    "stage_run",
    "stroke",
    "token",
    "training_tally",
    "worker",
]
