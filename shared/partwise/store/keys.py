"""Names inside the array store: safe keys, and block names that are unique and carry their time."""

import re
import secrets
from datetime import UTC, datetime
from uuid import UUID

from partwise.errors import ParameterError

_KEY = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]*(/[A-Za-z0-9_-][A-Za-z0-9._-]*)*")
_MAX_KEY = 512
BLOCKS = "blocks"
STAGING = "staging"


def checked_key(key: str) -> str:
    """The key itself if it is safe on every backend.

    Raises
    ------
    ParameterError : empty, absolute, longer than 512, with `..`, or a segment that starts with a dot or holds anything
        but letters, digits, `.`, `_` and `-`.
    """
    if not _KEY.fullmatch(key) or len(key) > _MAX_KEY:
        raise ParameterError(
            f"a key must be relative, of letters, digits, '.', '_', '-' and '/', no segment starting with a dot, "
            f"at most {_MAX_KEY} long, but is {key[:80]!r}"
        )
    return key


def new_block_name(kind: str, now: datetime) -> str:
    """`blocks/<kind>/<uuid>`, where the UUID (version 7) begins with the time in milliseconds."""
    milliseconds = int(now.timestamp() * 1000)
    value = milliseconds << 80 | secrets.randbits(80)
    value = value & ~(0xF << 76) | 0x7 << 76  # version
    value = value & ~(0x3 << 62) | 0x2 << 62  # variant
    return checked_key(f"{BLOCKS}/{kind}/{UUID(int=value)}")


def checked_block_name(name: str) -> str:
    """The name itself if it is one that `new_block_name` could have made. Raises `ParameterError` otherwise."""
    block_time(name)
    return name


def block_time(name: str) -> datetime:
    """When the writing of a block began, to the millisecond. Raises `ParameterError` if it is no block name."""
    folder, _, last = checked_key(name).rpartition("/")
    try:
        value = UUID(last)
    except ValueError:
        value = None
    if value is None or value.version != 7 or str(value) != last or folder.split("/")[:-1] != [BLOCKS]:
        raise ParameterError(f"a block's name must look like {BLOCKS}/<kind>/<uuid> but is {name!r}")
    return datetime.fromtimestamp((value.int >> 80) / 1000, UTC)
