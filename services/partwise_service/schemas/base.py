"""What all schemas share."""

from typing import Annotated, Generic, TypeVar

from fastapi import Path
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from partwise.errors import ParameterError

MAX_ROW_ID = 2**31 - 1  # of an INTEGER column in PostgreSQL
RowId = Annotated[int, Path(ge=1, le=MAX_ROW_ID)]
"""An id in a path."""


def _whole(value: object) -> object:
    return int(value) if isinstance(value, float) and value.is_integer() else value


WHOLE = BeforeValidator(_whole)
"""Of an integer in a body, after its limits: 7.0 is one, too, as JSON Schema has it."""
AnyId = Annotated[int, Field(ge=1, le=MAX_ROW_ID), WHOLE]
"""An id in a body."""
Hash = Annotated[str, Path(pattern="^[0-9a-f]{64}$", description="SHA-256, in hexadecimal.")]

NO_NUL = Field(pattern=r"^[^\x00]*$")
"""Of free text: PostgreSQL cannot hold the character 0."""

Row = TypeVar("Row")


class Answer(BaseModel):
    """Something the service says."""

    model_config = ConfigDict(frozen=True, from_attributes=True)


class Request(BaseModel):
    """Something the service is told: unknown fields are refused, and so is text where a number belongs."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Page(Answer, Generic[Row]):
    """A page of a list. `next` goes into `after` for the next page; null at the end."""

    items: list[Row]
    next: str | None = None


def refuse_unprintable(what: str, text: str) -> None:
    """Raises `ParameterError` for text with what cannot be seen on a screen, such as line breaks and controls."""
    if not text.isprintable():
        raise ParameterError(f"{what} must be printable but is {text!a:.80}; leave out what cannot be seen")
