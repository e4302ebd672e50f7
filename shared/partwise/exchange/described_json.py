"""Part tables and provenance as JSON objects: one wording for all formats that carry them."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from partwise.errors import FileFormatError, PartwiseError
from partwise.exchange.labelled_mesh import Provenance
from partwise.exchange.parts import PartEntry, PartTable

_Types = Mapping[str, type | tuple[type, ...]]

_PART_TYPES: _Types = {"id": int, "name": str, "colour": str, "gloss": str, "parent_id": (int, type(None))}
_PROVENANCE_TYPES: _Types = {
    **{"source_key": str, "source_hash": str, "kind": str, "model_version": (int, type(None))},
    "partwise_version": str,
}


def parts_document(parts: PartTable) -> dict[str, Any]:
    """`{"version": …, "parts": [{"id", "name", "colour", "gloss", "parent_id"}, …]}`."""
    return asdict(parts)


def parts_from_document(document: object) -> PartTable:
    """The part table of `parts_document`.

    Raises
    ------
    FileFormatError : a field is missing, unknown or of another type, or the parts contradict each other.
    """
    fields = checked_fields(document, {"version": int, "parts": (list, tuple)}, "the schema")
    try:
        entries = (PartEntry(**checked_fields(part, _PART_TYPES, "a part")) for part in fields["parts"])
        return PartTable(fields["version"], tuple(entries))
    except FileFormatError:
        raise
    except PartwiseError as error:
        raise FileFormatError(str(error)) from error


def provenance_document(provenance: Provenance | None) -> dict[str, Any] | None:
    """The fields of `Provenance`, or None."""
    return None if provenance is None else asdict(provenance)


def provenance_from_document(document: object) -> Provenance | None:
    """The provenance of `provenance_document`; FileFormatError as `parts_from_document`."""
    if document is None:
        return None
    try:
        return Provenance(**checked_fields(document, _PROVENANCE_TYPES, "the provenance"))
    except FileFormatError:
        raise
    except PartwiseError as error:
        raise FileFormatError(str(error)) from error


def load_json(text: str | bytes, what: str) -> Any:
    """The JSON value of `text`.

    Raises
    ------
    FileFormatError : it is not JSON, or nested deeper than any real file.
    """
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"{what} must be JSON but {error}; is the file truncated?") from error


def checked_fields(document: object, types: _Types, what: str) -> dict[str, Any]:
    """`document` as a dictionary with exactly these keys, each of its type; a bool is no int.

    Raises
    ------
    FileFormatError : it is not; says which field.
    """
    if not isinstance(document, dict) or document.keys() != types.keys():
        found = sorted(map(str, document)) if isinstance(document, dict) else type(document).__name__
        raise FileFormatError(f"{what} must have the fields {sorted(types)} but has {str(found)[:200]}; export again")
    for name, kind in types.items():
        if not isinstance(document[name], kind) or isinstance(document[name], bool):
            raise FileFormatError(
                f"{name} of {what} must be another type but is {str(document[name])[:80]!r}; export the file again"
            )
    return document
