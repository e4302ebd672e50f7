"""How a collection is doing."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Protocol

from partwise.store.records import BlockTotal, LeaseCounts, ModelRound, PersonFigures


class FigureCatalog(Protocol):
    """Figures for those who run a collection. Some grow with it: ask now and then, not for each page view."""

    def lease_counts(self, collection_id: int) -> LeaseCounts: ...

    def scored_by(self, collection_id: int, score_name: str) -> Mapping[int, int]:
        """How many shapes' latest score of this name is of each model version."""
        ...

    def stages_of_model(self, collection_id: int, model_version: int) -> Mapping[str, int]:
        """How many shapes each stage is done for with that model, on their present mesh; none where none is."""
        ...

    def block_totals(self) -> Sequence[BlockTotal]:
        """Blocks on record, by kind."""
        ...

    def database_bytes(self) -> int:
        """What the catalog takes on disk."""
        ...

    def person_figures(self, collection_id: int, since: datetime) -> Sequence[PersonFigures]:
        """What people confirmed since then, by name; people who confirmed nothing are left out."""
        ...

    def model_rounds(self, collection_id: int, score_name: str) -> Sequence[ModelRound]:
        """Every model with how it scored and what happened until the next one, newest first."""
        ...
