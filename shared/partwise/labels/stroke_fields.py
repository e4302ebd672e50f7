"""`Fields`: typed reading of a JSON object that knows which keys nobody asked for."""

import math
from collections.abc import Mapping
from typing import Any

from partwise.errors import FileFormatError

_EXACT = 2**53  # whole numbers up to here are the same as float64


class Fields:
    """A JSON object called `what` in messages. Every reader raises FileFormatError on a missing or mistyped key.

    `true` is no number, though Python thinks so, and 3.0 is no whole number, though JavaScript thinks so: it writes 3.
    Text is what every database keeps and every program reads back: Unicode without half characters and the character 0.
    """

    def __init__(self, document: Mapping[str, Any], what: str) -> None:
        self._document = document
        self._what = what
        self._unread = set(document)

    def text(self, key: str) -> str:
        value = self._value(key)
        return value if _is_text(value) else self._refuse(key, "text", value)

    def whole(self, key: str) -> int:
        value = self._value(key)
        return value if _is_whole(value) else self._refuse(key, "a whole number", value)

    def whole_or_none(self, key: str) -> int | None:
        return None if self._value(key) is None else self.whole(key)

    def number(self, key: str) -> float:
        value = self._value(key)
        if _is_whole(value) and abs(value) <= _EXACT:
            return float(value)
        is_good = isinstance(value, float) and math.isfinite(value)
        return value if is_good else self._refuse(key, "a finite number", value)

    def number_or_none(self, key: str) -> float | None:
        return None if self._value(key) is None else self.number(key)

    def wholes(self, key: str) -> list[int]:
        value = self._value(key)
        is_good = isinstance(value, list) and all(_is_whole(item) for item in value)
        return value if is_good else self._refuse(key, "a list of whole numbers", value)

    def whole_pairs(self, key: str) -> list[tuple[int, int]]:
        value = self._value(key)
        if not isinstance(value, list) or not all(_is_pair(item) for item in value):
            return self._refuse(key, "a list of pairs of whole numbers", value)
        return [(first, second) for first, second in value]

    def mapping(self, key: str) -> dict[str, Any]:
        value = self._value(key)
        is_good = isinstance(value, dict) and all(map(_is_text, value)) and all(map(_is_told, value.values()))
        return value if is_good else self._refuse(key, "an object of text and numbers", value)

    def objects(self, key: str) -> list[dict[str, Any]]:
        value = self._value(key)
        is_good = isinstance(value, list) and all(isinstance(item, dict) for item in value)
        return value if is_good else self._refuse(key, "a list of objects", value)

    def check_all_read(self) -> None:
        """Raises FileFormatError when the object has keys that no reader asked for."""
        if self._unread:
            raise FileFormatError(
                f"{self._what} has unknown keys {', '.join(sorted(self._unread))}; was it written by a newer Partwise?"
            )

    def _value(self, key: str) -> Any:
        if key not in self._document:
            raise FileFormatError(
                f"{self._what} must have {key!r} but has {', '.join(sorted(self._document)) or 'nothing'}"
            )
        self._unread.discard(key)
        return self._document[key]

    def _refuse(self, key: str, rule: str, value: Any) -> Any:
        shown = repr(value)
        shown = shown if len(shown) <= 60 else f"{shown[:57]}…"
        raise FileFormatError(f"{key!r} of {self._what} must be {rule} but is {shown}; correct whatever wrote it")


def _is_text(value: Any) -> bool:
    if not isinstance(value, str) or "\0" in value:
        return False
    return value.isascii() or not any("\ud800" <= character <= "\udfff" for character in value)


def _is_told(value: Any) -> bool:
    """Whether every program reads the value as it was written, if it is of a kind that they read at all."""
    if isinstance(value, str):
        return _is_text(value)
    return not isinstance(value, int) or abs(value) <= _EXACT


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_pair(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(_is_whole(item) for item in value)
