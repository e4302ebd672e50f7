"""What all schemas share."""

from typing import Annotated, Generic, TypeVar

from fastapi import Path
from pydantic import BaseModel, ConfigDict, Field

MAX_ROW_ID = 2**31 - 1  # of an INTEGER column in PostgreSQL
RowId = Annotated[int, Path(ge=1, le=MAX_ROW_ID)]
"""An id in a path."""
AnyId = Annotated[int, Field(ge=1, le=MAX_ROW_ID)]
"""An id in a body."""
Hash = Annotated[str, Path(pattern="^[0-9a-f]{64}$", description="SHA-256, in hexadecimal.")]

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
