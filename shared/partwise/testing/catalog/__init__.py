"""The conformance suite of `Catalog`."""

from partwise.testing.catalog.collections import CollectionConformance
from partwise.testing.catalog.figures import FigureConformance
from partwise.testing.catalog.labels import LabelConformance
from partwise.testing.catalog.models import ModelConformance
from partwise.testing.catalog.reviews import ReviewConformance
from partwise.testing.catalog.shapes import ShapeConformance
from partwise.testing.catalog.stages import StageConformance


class CatalogConformance(
    CollectionConformance,
    ShapeConformance,
    StageConformance,
    FigureConformance,
    LabelConformance,
    ReviewConformance,
    ModelConformance,
):
    """What every `Catalog` must pass. A subclass provides a pytest fixture `catalog`: an empty catalog."""
