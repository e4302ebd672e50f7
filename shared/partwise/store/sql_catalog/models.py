"""Models, scores, selection, embedding."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import models, ranks, stages
from partwise.store.sql_catalog.base import SqlBase


class SqlModelCatalog(SqlBase):
    def save_model(self, model: r.NewModel) -> r.Model:
        with writing(self._engine) as connection:
            return models.save_model(connection, model, self._clock())

    def latest_model(self, collection_id: int) -> r.Model | None:
        with reading(self._engine) as connection:
            return models.latest_model(connection, collection_id)

    def model(self, collection_id: int, version: int) -> r.Model:
        with reading(self._engine) as connection:
            return models.model(connection, collection_id, version)

    def models(self, collection_id: int, *, before: int | None = None, limit: int = 1000) -> Sequence[r.Model]:
        with reading(self._engine) as connection:
            return models.models(connection, collection_id, before, limit)

    def trained_on(self, model_id: int) -> Sequence[int]:
        with reading(self._engine) as connection:
            return models.trained_on(connection, model_id)

    def scores(self, shape_ids: SizedIterable[int], name: str) -> Mapping[int, r.Score]:
        with reading(self._engine) as connection:
            return stages.scores(connection, shape_ids, name)

    def queue(
        self,
        collection_id: int,
        score_name: str,
        *,
        descending: bool = True,
        limit: int = 100,
        after: r.QueueAnchor | None = None,
        states: Sequence[r.ShapeState] | None = None,
    ) -> Sequence[r.QueueRow]:
        with reading(self._engine) as connection:
            return models.queue(connection, collection_id, score_name, descending, limit, after, states)

    def highest_waiting(self, collection_id: int, score_name: str, limit: int) -> Sequence[int]:
        with reading(self._engine) as connection:
            return ranks.highest_waiting(connection, collection_id, score_name, limit)

    def out_of_rank(self, collection_id: int, score_name: str) -> Mapping[int, int]:
        with reading(self._engine) as connection:
            return ranks.out_of_rank(connection, collection_id, score_name)

    def replace_first_shapes(self, collection_id: int, first_shapes: Sequence[r.FirstShape]) -> None:
        with writing(self._engine) as connection:
            models.replace_first_shapes(connection, collection_id, first_shapes)

    def first_shapes(self, collection_id: int) -> Sequence[r.FirstShape]:
        with reading(self._engine) as connection:
            return models.first_shapes(connection, collection_id)

    def set_embedding(self, collection_id: int, key: str, *, replacing: str | None = None) -> bool:
        with writing(self._engine) as connection:
            return models.set_embedding(connection, collection_id, key, replacing, self._clock())

    def embedding(self, collection_id: int) -> r.Embedding | None:
        with reading(self._engine) as connection:
            return models.embedding(connection, collection_id)
