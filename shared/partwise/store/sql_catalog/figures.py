"""How a collection is doing."""

from collections.abc import Mapping, Sequence
from datetime import datetime

from partwise.store import records as r
from partwise.store.engine import reading
from partwise.store.sql import figures, rounds
from partwise.store.sql_catalog.base import SqlBase


class SqlFigureCatalog(SqlBase):
    def lease_counts(self, collection_id: int) -> r.LeaseCounts:
        with reading(self._engine) as connection:
            return figures.lease_counts(connection, collection_id, self._clock())

    def scored_by(self, collection_id: int, score_name: str) -> Mapping[int, int]:
        with reading(self._engine) as connection:
            return figures.scored_by(connection, collection_id, score_name)

    def stages_of_model(self, collection_id: int, model_version: int) -> Mapping[str, int]:
        with reading(self._engine) as connection:
            return figures.stages_of_model(connection, collection_id, model_version)

    def block_totals(self) -> Sequence[r.BlockTotal]:
        with reading(self._engine) as connection:
            return figures.block_totals(connection)

    def database_bytes(self) -> int:
        with reading(self._engine) as connection:
            return figures.database_bytes(connection)

    def person_figures(self, collection_id: int, since: datetime) -> Sequence[r.PersonFigures]:
        with reading(self._engine) as connection:
            return figures.person_figures(connection, collection_id, since)

    def model_rounds(self, collection_id: int, score_name: str) -> Sequence[r.ModelRound]:
        with reading(self._engine) as connection:
            return rounds.model_rounds(connection, collection_id, score_name)
