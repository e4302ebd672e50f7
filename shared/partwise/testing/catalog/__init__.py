"""The conformance suite of `Catalog`."""

from partwise.testing.catalog.collections import CollectionConformance
from partwise.testing.catalog.confirmations import ConfirmationConformance
from partwise.testing.catalog.drafts import DraftConformance
from partwise.testing.catalog.figures import FigureConformance
from partwise.testing.catalog.jobs import EventConformance, JobConformance
from partwise.testing.catalog.labels import LabelConformance
from partwise.testing.catalog.listing import ListingConformance
from partwise.testing.catalog.models import ModelConformance
from partwise.testing.catalog.queue import QueueConformance
from partwise.testing.catalog.ranking import RankingConformance
from partwise.testing.catalog.reviews import ReviewConformance
from partwise.testing.catalog.shapes import ShapeConformance
from partwise.testing.catalog.stages import StageConformance
from partwise.testing.catalog.tokens import TokenConformance


class CatalogConformance(
    CollectionConformance,
    ShapeConformance,
    StageConformance,
    LabelConformance,
    ReviewConformance,
    ModelConformance,
    QueueConformance,
    RankingConformance,
    DraftConformance,
    ConfirmationConformance,
    JobConformance,
    EventConformance,
    TokenConformance,
    ListingConformance,
    FigureConformance,
):
    """What every `Catalog` must pass. A subclass provides a pytest fixture `catalog`: an empty catalog."""
