"""How large an archive may be, and grow, before it is refused."""

from dataclasses import dataclass, field

from partwise.errors import FileFormatError, ParameterError
from partwise.io.limits import MIB, ReadLimits

CHUNK = MIB
"""Bytes that are expanded at a time."""


class ArchiveError(FileFormatError):
    """An archive that is refused as a whole: damaged, too large, or built to harm."""


@dataclass(frozen=True, slots=True)
class ArchiveLimits:
    """Upper bounds on one archive, all inclusive.

    max_members : entries, folders among them. max_total_bytes : of all members together, expanded.
    max_ratio : expanded bytes to compressed ones, of a zip's member or a tar.gz so far, one MiB in all aside; text of
    meshes reaches about 10.
    member : of each file that is read.
    """

    max_members: int = 100_000
    max_total_bytes: int = 64 * 1024 * MIB
    max_ratio: int = 200
    member: ReadLimits = field(default_factory=ReadLimits)

    def __post_init__(self) -> None:
        for name in ("max_members", "max_total_bytes", "max_ratio"):
            if getattr(self, name) < 1:
                raise ParameterError(f"{name} must be at least 1 but is {getattr(self, name)}; raise it")
