"""Models, scores, the selection and the embedding."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Protocol

from partwise.store.records import Embedding, FirstShape, Model, NewModel, QueueAnchor, QueueRow, Score, ShapeState


class ModelCatalog(Protocol):
    """Models, scores, the selection and the embedding."""

    def save_model(self, model: NewModel) -> Model:
        """Commit a model under the next version of its collection. `NotFoundError` for an unknown revision."""
        ...

    def latest_model(self, collection_id: int) -> Model | None: ...

    def model(self, collection_id: int, version: int) -> Model: ...

    def models(self, collection_id: int, *, before: int | None = None, limit: int = 1000) -> Sequence[Model]:
        """A page of models, newest first: those of a version before the given one."""
        ...

    def trained_on(self, model_id: int) -> Sequence[int]:
        """The label revisions that a model learned from."""
        ...

    def scores(self, shape_ids: SizedIterable[int], name: str) -> Mapping[int, Score]:
        """The latest score of this name for each shape; shapes without one are left out."""
        ...

    def queue(
        self,
        collection_id: int,
        score_name: str,
        *,
        descending: bool = True,
        limit: int = 100,
        after: QueueAnchor | None = None,
        states: Sequence[ShapeState] | None = None,
    ) -> Sequence[QueueRow]:
        """A page of scored shapes in order of the score, ties by id, of these states if given."""
        ...

    def highest_waiting(self, collection_id: int, score_name: str, limit: int) -> Sequence[int]:
        """Shapes that wait for labels, free or held, highest score first."""
        ...

    def out_of_rank(self, collection_id: int, score_name: str) -> Mapping[int, int]:
        """The ranks due to shapes that wait at another one than their score gives them, lowest first.

        A higher score gives a lower rank, behind those below `FIRST_BY_SCORE` and before shapes that nothing ranked.
        Shapes without the score are left out, and so are those that were sent back.
        """
        ...

    def replace_first_shapes(self, collection_id: int, first_shapes: Sequence[FirstShape]) -> None: ...

    def first_shapes(self, collection_id: int) -> Sequence[FirstShape]:
        """The current selection, by ordinal."""
        ...

    def set_embedding(self, collection_id: int, key: str, *, replacing: str | None = None) -> bool:
        """Names the collection's embedding. replacing : only where this is its key still; whether it was."""
        ...

    def embedding(self, collection_id: int) -> Embedding | None: ...
