"""Uploads and ingest: what was sent, and what is to be taken from where."""

from datetime import datetime
from typing import Annotated

from pydantic import Field

from partwise.store.large_objects import LargeObject
from partwise_service.schemas.base import NO_NUL, Answer, Request

MAX_PATH = 1_000
Text = Annotated[str, NO_NUL, Field(min_length=1, max_length=MAX_PATH)]


class UploadOut(Answer):
    """A file that waits to be ingested. sha256 : of its bytes, in hexadecimal. person : who sent it."""

    upload_id: str
    name: str
    n_bytes: int
    sha256: str
    person: str
    created_at: datetime
    expires_at: datetime

    @classmethod
    def of(cls, upload: LargeObject) -> "UploadOut":
        """The upload as it is told."""
        about = upload.about
        return cls(
            upload_id=upload.name,
            name=about["name"],
            n_bytes=upload.n_bytes,
            sha256=upload.sha256,
            person=about["person"],
            created_at=about["created_at"],
            expires_at=upload.expires_at,
        )


class UploadsOut(Answer):
    items: list[UploadOut]
    next: None = None


class IngestRequest(Request):
    """Either an upload, or a prefix that the machine's operator has listed and a path below it."""

    upload_id: Text | None = None
    prefix: Text | None = None
    path: Annotated[str, NO_NUL, Field(max_length=MAX_PATH)] | None = None


class PrefixesOut(Answer):
    """Names of prefixes that the caller may ingest from."""

    items: list[str]
    next: None = None
