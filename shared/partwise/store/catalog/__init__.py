"""`Catalog`: everything a person made, and what the machine has done so far, as rows.

Each method is one transaction: when it returns, it is committed. Lists are pages in order of a key: pass the last key
of one page as `after` to get the next; an empty page is the end. Methods raise `NotFoundError` for an id or a name that
is not there and `StoreError` when the database cannot be reached or written, beside what they name themselves.
"""

from typing import Protocol

from partwise.store.catalog.accepts import AcceptCatalog
from partwise.store.catalog.collections import AuditCatalog, CollectionCatalog
from partwise.store.catalog.drafts import DraftCatalog
from partwise.store.catalog.events import EventCatalog
from partwise.store.catalog.figures import FigureCatalog
from partwise.store.catalog.jobs import JobCatalog
from partwise.store.catalog.labels import SHOWN_KINDS, LabelCatalog
from partwise.store.catalog.listing import ListingCatalog
from partwise.store.catalog.models import ModelCatalog
from partwise.store.catalog.queue import QueueCatalog
from partwise.store.catalog.shapes import ShapeCatalog
from partwise.store.catalog.stages import StageCatalog
from partwise.store.catalog.tokens import TokenCatalog

__all__ = [
    "SHOWN_KINDS",
    "AcceptCatalog",
    "AuditCatalog",
    "Catalog",
    "CollectionCatalog",
    "DraftCatalog",
    "EventCatalog",
    "FigureCatalog",
    "JobCatalog",
    "LabelCatalog",
    "ListingCatalog",
    "ModelCatalog",
    "QueueCatalog",
    "ShapeCatalog",
    "StageCatalog",
    "TokenCatalog",
]


class Catalog(
    CollectionCatalog,
    ShapeCatalog,
    StageCatalog,
    LabelCatalog,
    ModelCatalog,
    QueueCatalog,
    DraftCatalog,
    JobCatalog,
    TokenCatalog,
    EventCatalog,
    ListingCatalog,
    AcceptCatalog,
    FigureCatalog,
    AuditCatalog,
    Protocol,
):
    """The whole catalog. Depend on the smallest of its parts that does."""

    def close(self) -> None: ...
