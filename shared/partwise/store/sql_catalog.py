"""`SqlCatalog`: the catalog on SQLite or PostgreSQL. Each method opens one transaction and leaves the rest to `sql`."""

from collections.abc import Callable, Mapping, Sequence
from collections.abc import Collection as SizedIterable
from datetime import UTC, datetime
from types import TracebackType
from typing import Any, Self

import numpy as np
from jaxtyping import UInt16
from sqlalchemy import Engine

from partwise.labels.schema import PartSchema
from partwise.store import records as r
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.engine import reading, writing
from partwise.store.reviews import NewReview, Review
from partwise.store.sql import blocks, collections, labels, models, reviews, shapes, stages


def utc_now() -> datetime:
    """The present, aware, in UTC."""
    return datetime.now(UTC)


class SqlCatalog:
    """A catalog in a database of the known schema; get one from `partwise.store.open`. Safe to share between threads.

    `clock` gives the times that rows carry. Close it, or use it in a `with` block. See `Catalog` for what methods do.
    """

    def __init__(self, engine: Engine, clock: Callable[[], datetime] = utc_now) -> None:
        self._engine = engine
        self._clock = clock

    def close(self) -> None:
        self._engine.dispose()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # Collections, parts, people

    def create_collection(
        self, name: str, part_names: Sequence[str], settings: Mapping[str, Any] | None = None
    ) -> r.Collection:
        with writing(self._engine) as connection:
            return collections.create_collection(connection, name, part_names, settings or {}, self._clock())

    def get_collection(self, name: str) -> r.Collection:
        with reading(self._engine) as connection:
            return collections.get_collection(connection, name)

    def list_collections(self) -> Sequence[r.Collection]:
        with reading(self._engine) as connection:
            return collections.list_collections(connection)

    def update_collection_settings(self, collection_id: int, settings: Mapping[str, Any]) -> r.Collection:
        with writing(self._engine) as connection:
            return collections.update_settings(connection, collection_id, settings, self._clock())

    def parts(self, collection_id: int, version: int | None = None) -> PartSchema:
        with reading(self._engine) as connection:
            return collections.parts(connection, collection_id, version)

    def add_part(
        self,
        collection_id: int,
        name: str,
        colour: str | None = None,
        gloss: str = "",
        parent_id: int | None = None,
    ) -> PartSchema:
        with writing(self._engine) as connection:
            return collections.add_part(connection, collection_id, name, colour, gloss, parent_id)

    def update_part(
        self,
        collection_id: int,
        part_id: int,
        *,
        name: str | None = None,
        colour: str | None = None,
        gloss: str | None = None,
        parent_id: int | None = None,
    ) -> PartSchema:
        with writing(self._engine) as connection:
            return collections.update_part(connection, collection_id, part_id, name, colour, gloss, parent_id)

    def remove_part(self, collection_id: int, part_id: int) -> PartSchema:
        with writing(self._engine) as connection:
            return collections.remove_part(connection, collection_id, part_id)

    def add_person(self, name: str) -> r.Person:
        with writing(self._engine) as connection:
            return collections.add_person(connection, name, self._clock())

    def get_person(self, name: str) -> r.Person:
        with reading(self._engine) as connection:
            return collections.get_person(connection, name)

    def list_people(self) -> Sequence[r.Person]:
        with reading(self._engine) as connection:
            return collections.list_people(connection)

    # Shapes and meshes

    def add_shapes(self, collection_id: int, batch: Sequence[r.NewShape]) -> Sequence[r.IngestedShape]:
        with writing(self._engine) as connection:
            return shapes.add_shapes(connection, collection_id, batch, self._clock())

    def shape(self, shape_id: int) -> r.Shape:
        with reading(self._engine) as connection:
            return shapes.refuse_unknown_shapes(connection, [shape_id])[shape_id]

    def shapes_by_id(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Shape]:
        with reading(self._engine) as connection:
            return shapes.shapes_by_id(connection, shape_ids)

    def shape_by_key(self, collection_id: int, source_key: str) -> r.Shape:
        with reading(self._engine) as connection:
            return shapes.shape_by_key(connection, collection_id, source_key)

    def shapes(
        self, collection_id: int, *, after: int = 0, limit: int = 1000, state: r.ShapeState | None = None
    ) -> Sequence[r.Shape]:
        with reading(self._engine) as connection:
            return shapes.shapes(connection, collection_id, after, limit, state)

    def shape_states(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.ShapeState]:
        with reading(self._engine) as connection:
            return shapes.shape_states(connection, shape_ids)

    def state_counts(self, collection_id: int) -> Mapping[r.ShapeState, int]:
        with reading(self._engine) as connection:
            return shapes.state_counts(connection, collection_id)

    def mesh(self, shape_id: int, mesh_hash: str) -> r.Mesh:
        with reading(self._engine) as connection:
            return shapes.mesh(connection, shape_id, mesh_hash)

    def meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Mesh]:
        with reading(self._engine) as connection:
            return shapes.meshes(connection, shape_ids, r.MeshRole.WORKING)

    def original_meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Mesh]:
        with reading(self._engine) as connection:
            return shapes.meshes(connection, shape_ids, r.MeshRole.ORIGINAL)

    def keep_mesh(self, mesh_hash: str, kept_key: str) -> None:
        with writing(self._engine) as connection:
            shapes.keep_mesh(connection, mesh_hash, kept_key)

    # Stage runs and blocks

    def publish_block(
        self,
        block: r.NewBlock,
        runs: Sequence[r.NewStageRun],
        scores: Sequence[r.NewScore] = (),
        meshes: Sequence[r.NewMesh] = (),
    ) -> int:
        with writing(self._engine) as connection:
            return stages.publish_block(connection, block, runs, scores, meshes, self._clock())

    def record_done(self, runs: Sequence[r.NewStageRun], scores: Sequence[r.NewScore] = ()) -> None:
        with writing(self._engine) as connection:
            stages.record_done(connection, runs, scores, self._clock())

    def record_failure(self, failure: r.NewFailure) -> None:
        with writing(self._engine) as connection:
            stages.record_failure(connection, failure, self._clock())

    def clear_failures(
        self,
        collection_id: int,
        stage: str | None = None,
        shape_ids: SizedIterable[int] | None = None,
        *,
        kind: r.FailureKind | None = None,
        reason_contains: str = "",
    ) -> int:
        with writing(self._engine) as connection:
            return stages.clear_failures(connection, collection_id, stage, shape_ids, kind, reason_contains)

    def stage_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, r.StageRun]:
        with reading(self._engine) as connection:
            return stages.stage_runs(connection, shape_ids, stage)

    def failed_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, r.StageRun]:
        with reading(self._engine) as connection:
            return stages.failed_runs(connection, shape_ids, stage)

    def failures(
        self, collection_id: int, *, stage: str | None = None, after: int = 0, limit: int = 1000
    ) -> Sequence[r.Failure]:
        with reading(self._engine) as connection:
            return stages.failures(connection, collection_id, stage, after, limit)

    def stage_counts(self, collection_id: int) -> Sequence[r.StageCount]:
        with reading(self._engine) as connection:
            return stages.stage_counts(connection, collection_id)

    def block(self, name: str) -> r.Block:
        with reading(self._engine) as connection:
            return blocks.block(connection, name)

    def visible_blocks(self, *, after: int = 0, limit: int = 1000) -> Sequence[r.Block]:
        with reading(self._engine) as connection:
            return blocks.visible_blocks(connection, after, limit)

    def unused_blocks(self, *, limit: int = 1000) -> Sequence[r.Block]:
        with reading(self._engine) as connection:
            return blocks.unused_blocks(connection, limit)

    def supersede_block(self, name: str) -> int:
        with writing(self._engine) as connection:
            return blocks.supersede_block(connection, name)

    def delete_blocks(self, names: SizedIterable[str]) -> None:
        with writing(self._engine) as connection:
            blocks.delete_blocks(connection, names)

    # Labels

    def add_revision(self, revision: r.NewRevision, review: NewReview | None = None) -> r.LabelRevision:
        with writing(self._engine) as connection:
            return labels.add_revision(connection, revision, review, self._clock())

    def revision(self, revision_id: int) -> r.LabelRevision:
        with reading(self._engine) as connection:
            return labels.revision(connection, revision_id)

    def revisions(self, shape_id: int) -> Sequence[r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.revisions(connection, shape_id)

    def labels(self, revision_id: int) -> UInt16[np.ndarray, " m"]:
        with reading(self._engine) as connection:
            return labels.labels(connection, revision_id)

    def head_revision(self, shape_id: int, kinds: Sequence[r.RevisionKind] = SHOWN_KINDS) -> r.LabelRevision | None:
        with reading(self._engine) as connection:
            return labels.head_revisions(connection, [shape_id], kinds).get(shape_id)

    def head_revisions(
        self, shape_ids: SizedIterable[int], kinds: Sequence[r.RevisionKind] = SHOWN_KINDS
    ) -> Mapping[int, r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.head_revisions(connection, shape_ids, kinds)

    def labelled_shapes(
        self,
        collection_id: int,
        *,
        kinds: Sequence[r.RevisionKind] = SHOWN_KINDS,
        after: int = 0,
        limit: int = 1000,
        leave_out_reviews: bool = False,
    ) -> Sequence[r.LabelRevision]:
        with reading(self._engine) as connection:
            return labels.labelled_shapes(
                connection, collection_id, kinds, after, limit, leave_out_reviews=leave_out_reviews
            )

    def add_review(self, revision_id: int, review: NewReview) -> Review:
        with writing(self._engine) as connection:
            return reviews.add_review(connection, revision_id, review, self._clock())

    def open_reviews(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> Sequence[Review]:
        with reading(self._engine) as connection:
            return reviews.open_reviews(connection, collection_id, after, limit)

    def reviews(self, shape_id: int) -> Sequence[Review]:
        with reading(self._engine) as connection:
            return reviews.reviews(connection, shape_id)

    def accept_review(self, review_id: int, person_id: int) -> Review:
        with writing(self._engine) as connection:
            return reviews.accept_review(connection, review_id, person_id, self._clock())

    # Models, scores, selection, embedding

    def save_model(self, model: r.NewModel) -> r.Model:
        with writing(self._engine) as connection:
            return models.save_model(connection, model, self._clock())

    def latest_model(self, collection_id: int) -> r.Model | None:
        with reading(self._engine) as connection:
            return next(iter(models.models(connection, collection_id, limit=1)), None)

    def model(self, collection_id: int, version: int) -> r.Model:
        with reading(self._engine) as connection:
            return models.model(connection, collection_id, version)

    def models(self, collection_id: int) -> Sequence[r.Model]:
        with reading(self._engine) as connection:
            return models.models(connection, collection_id)

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

    def replace_first_shapes(self, collection_id: int, first_shapes: Sequence[r.FirstShape]) -> None:
        with writing(self._engine) as connection:
            models.replace_first_shapes(connection, collection_id, first_shapes)

    def first_shapes(self, collection_id: int) -> Sequence[r.FirstShape]:
        with reading(self._engine) as connection:
            return models.first_shapes(connection, collection_id)

    def set_embedding(self, collection_id: int, key: str) -> None:
        with writing(self._engine) as connection:
            models.set_embedding(connection, collection_id, key, self._clock())

    def embedding(self, collection_id: int) -> r.Embedding | None:
        with reading(self._engine) as connection:
            return models.embedding(connection, collection_id)

    # Audit

    def append_audit(self, actor: str, action: str, subject: str, detail: Mapping[str, Any] | None = None) -> None:
        with writing(self._engine) as connection:
            collections.append_audit(connection, actor, action, subject, detail or {}, self._clock())

    def audit(self, *, after: int = 0, limit: int = 1000) -> Sequence[r.AuditEntry]:
        with reading(self._engine) as connection:
            return collections.audit(connection, after, limit)
