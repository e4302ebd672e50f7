"""Strokes as the API's document tells them, one schema for each kind.

What is sent is read by `partwise.labels.stroke_json`, once and for all programs. To validate it here as well would
double what a stroke costs, so that these schemas only describe it; a test holds them to what is read.
"""

from typing import Annotated, Any, Literal

from pydantic import (
    AwareDatetime,
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    JsonValue,
    RootModel,
    StringConstraints,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from partwise.labels.operations import DeltaSource
from partwise.labels.schema import MAX_PART_ID
from partwise.labels.strokes import MAX_ROW_ID

MAX_SEEDS = 10_000
"""Of a stroke that paints."""
Face = Annotated[int, Field(ge=0, description="A face of the draft's mesh, from 0.")]
Label = Annotated[int, Field(ge=0, le=MAX_PART_ID, description="A part's id; 0: unlabelled.")]
Run = Annotated[  # a pair in so many words: generated clients lose tuples on the way
    list[Annotated[int, Field(ge=0)]], Field(min_length=2, max_length=2, description="The first face, and how many.")
]


class _Stroke(BaseModel):
    model_config = ConfigDict(extra="forbid")

    v: Literal[1]
    id: Annotated[
        str,
        Field(json_schema_extra={"format": "uuid"}, description="Made by the client; the same id is the same stroke."),
    ]
    sequence: Annotated[int, Field(ge=0, lt=MAX_ROW_ID, description="How many strokes of the draft come before it.")]
    base_revision: Annotated[int, Field(ge=1, le=MAX_ROW_ID)] | None = Field(description="The draft's.")
    author_id: Annotated[int, Field(ge=1, le=MAX_ROW_ID, description="The caller's person id: see /me.")]
    at: Annotated[AwareDatetime, Field(description="When it was made.")]


class PaintStroke(_Stroke):
    """A click or a drag with the brush: faces near each seed, joined to it, get the label.

    radius : between centroids, as a share of the diagonal of the mesh's bounding box. min_cosine : the least cosine of
    the angle to the seed's normal; null for any. only_over : the label of the only faces that are taken; null for all.
    """

    kind: Literal["paint"]
    seeds: Annotated[list[Face], Field(min_length=1, max_length=MAX_SEEDS)]
    radius: Annotated[float, Field(gt=0, le=1)]
    min_cosine: Annotated[float, Field(ge=-1, le=1)] | None
    label: Label
    only_over: Label | None


class AssignStroke(_Stroke):
    """Given faces get the label. runs : the first face and the count of each run, ascending, not overlapping."""

    kind: Literal["assign"]
    runs: Annotated[list[Run], Field(min_length=1)]
    label: Label


class SegmentWideStroke(_Stroke):
    """The connected region of equal label around the seed gets the label."""

    kind: Literal["segment_wide"]
    seed: Face
    label: Label


class DeltaStroke(_Stroke):
    """What a tool made of the labels, as a difference.

    payload : base64 of a zlib stream of `n_runs` first faces (little-endian u32), as many counts (u32) and as many
        labels (u16) of runs of faces; the runs ascend and do not overlap.
    sha256 : of all labels afterwards, as little-endian u16. parameters : for people to read.
    """

    kind: Literal["delta"]
    source: DeltaSource
    parameters: dict[str, str | int | float | bool | None]
    n_faces: Annotated[int, Field(ge=1, description="Of the draft's mesh.")]
    n_runs: Annotated[int, Field(ge=0)]
    payload: Annotated[str, Field(json_schema_extra={"contentEncoding": "base64"})]
    sha256: Annotated[str, StringConstraints(pattern="^[0-9a-f]{64}$")]


class ClearStroke(_Stroke):
    """Every face becomes unlabelled."""

    kind: Literal["clear"]


class UndoStroke(_Stroke):
    """Takes back the last step that is not taken back; changes nothing if there is none."""

    kind: Literal["undo"]


class RedoStroke(_Stroke):
    """Does again the step that was taken back last, if no step was done since."""

    kind: Literal["redo"]


class Stroke(
    RootModel[
        Annotated[
            PaintStroke | AssignStroke | SegmentWideStroke | DeltaStroke | ClearStroke | UndoStroke | RedoStroke,
            Field(discriminator="kind"),
        ]
    ]
):
    """One operation on a draft's labels, of one of seven kinds. A key that is missing or unknown is refused."""


_BY_NAME = core_schema.definitions_schema(  # a component of its own, however often it is told
    core_schema.definition_reference_schema("Stroke"),
    [{**Stroke.__pydantic_core_schema__, "ref": "Stroke"}],
)


class _ToldAsStroke:
    """Marks what the document tells as a stroke, whatever is validated."""

    def __get_pydantic_json_schema__(self, _validated: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        return handler(_BY_NAME)


SentStroke = Annotated[dict[str, JsonValue], _ToldAsStroke()]
"""A stroke in a request: any object."""
KeptStroke = Annotated[dict[str, Any], _ToldAsStroke()]
"""A stroke on record, which was read when it was sent."""
