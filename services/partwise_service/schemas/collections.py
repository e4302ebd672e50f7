"""Collections, their settings and their parts."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import Field, JsonValue

from partwise.labels.schema import PartSchema
from partwise.store.queue_settings import MAX_LABELS_PER_SHAPE
from partwise.store.records import Collection
from partwise_service.schemas.base import NO_NUL, WHOLE, Answer, AnyId, Request

PartName = Annotated[str, Field(min_length=1, max_length=64)]
Colour = Annotated[str, Field(pattern="^#[0-9A-Fa-f]{6}$", description="`#RRGGBB`.")]
Gloss = Annotated[str, NO_NUL, Field(max_length=2_000, description="What the part is, for annotators.")]


Share = Annotated[float, Field(ge=0, le=1)]


class CollectionOut(Answer):
    """A collection. `settings` holds what was set; what was not has its default, see docs/configuration.md."""

    id: int
    name: str
    settings: dict[str, JsonValue]
    schema_version: int
    created_at: datetime

    @classmethod
    def of(cls, collection: Collection) -> "CollectionOut":
        """The collection as it is told."""
        return cls.model_validate(collection)


class CollectionsOut(Answer):
    items: list[CollectionOut]


class NewCollection(Request):
    name: Annotated[str, Field(min_length=1, max_length=200)]
    parts: Annotated[list[PartName], Field(min_length=1, max_length=1_000)]


class SettingsChange(Request):
    """What is given is set, the rest stays. What each means is in docs/configuration.md and docs/service.md."""

    up: Literal["x", "y", "z"] | None = None
    working_faces: Annotated[int, Field(ge=100, le=1_000_000), WHOLE] | None = None
    remesh: Literal["auto", "never"] | None = None
    labels_per_shape: Annotated[int, Field(ge=1, le=MAX_LABELS_PER_SHAPE), WHOLE] | None = None
    agreement: Share | None = None
    honeypot_share: Share | None = None
    review: bool | None = None
    train_after: Annotated[int, Field(ge=0, le=1_000_000), WHOLE] | None = None


class PartOut(Answer):
    id: int
    name: str
    colour: str
    gloss: str
    parent_id: int | None


class PartsOut(Answer):
    """A part schema. Adding or removing a part makes the next version."""

    version: int
    parts: list[PartOut]

    @classmethod
    def of(cls, schema: PartSchema) -> "PartsOut":
        """The schema as it is told."""
        return cls(version=schema.version, parts=[PartOut.model_validate(part) for part in schema.parts])


class NewPart(Request):
    name: PartName
    colour: Colour | None = None
    gloss: Gloss = ""
    parent_id: AnyId | None = None


class PartChange(Request):
    """What is given changes, the rest stays. A `parent_id` of 0 puts the part at the top."""

    name: PartName | None = None
    colour: Colour | None = None
    gloss: Gloss | None = None
    parent_id: Annotated[int, Field(ge=0, le=65_535), WHOLE] | None = None
