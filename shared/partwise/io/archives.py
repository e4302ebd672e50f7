"""`read_archive`: the files of a zip or tar.gz archive that nobody vouches for, one after the other, in memory.

Nothing is written, linked, run or unpickled, and archives within archives are not opened, so what is in an archive can
only be bytes under a checked name. What is declared in it is not believed: bytes are counted as they come. A member
that breaks a rule is named and the rest goes on; an archive that is built to harm is refused as a whole.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Protocol

from partwise.errors import FileFormatError
from partwise.io.archive_limits import ArchiveError, ArchiveLimits
from partwise.io.tar_members import tar_members
from partwise.io.zip_members import zip_members

ARCHIVE_SUFFIXES = (".zip", ".tar.gz", ".tgz")
NESTED_SUFFIXES = frozenset({".zip", ".tgz", ".gz", ".tar", ".bz2", ".xz", ".zst", ".7z", ".rar"})
MAX_NAME = 1_000  # characters


@dataclass(frozen=True, slots=True, eq=False)
class ArchivedFile:
    """A file of an archive. name : its relative path, of plain steps."""

    name: str
    data: bytes = field(repr=False)


@dataclass(frozen=True, slots=True)
class RefusedMember:
    """A member that was not read: its name as printable text, and why, in one line."""

    name: str
    reason: str


class Member(Protocol):
    """What a format says of a member before it is read. fault : why its kind is refused, "" if it is a plain file."""

    @property
    def name(self) -> str: ...

    @property
    def is_folder(self) -> bool: ...

    @property
    def fault(self) -> str: ...

    def chunks(self) -> Iterator[bytes]:
        """The content, expanded, in pieces. FileFormatError if it is damaged or a bomb."""
        ...


def is_archive(name: str) -> bool:
    """Whether a file of this name is read as an archive."""
    return name.lower().endswith(ARCHIVE_SUFFIXES)


def read_archive(
    path: Path, is_wanted: Callable[[str], bool], limits: ArchiveLimits | None = None
) -> Iterator[ArchivedFile | RefusedMember]:
    """The archive's files whose names are wanted, in its order. Holds one of them at a time.

    Others are passed over without being read, and so is what is hidden, such as the notes that macOS adds.

    Raises
    ------
    FileFormatError : no such archive, damaged, too many members or bytes, members that overlap, or an expansion that
        no honest archive has. What was read before remains good.
    """
    bounds = limits or ArchiveLimits()
    if not is_archive(path.name):
        raise FileFormatError(f"an archive's name must end in {', '.join(ARCHIVE_SUFFIXES)} but is {path.name!a}")
    open_members: Callable[[Path, ArchiveLimits], Iterator[Member]] = (
        zip_members if path.name.lower().endswith(".zip") else tar_members
    )
    seen: set[str] = set()
    n_bytes = 0
    for n_members, member in enumerate(open_members(path, bounds), start=1):
        if n_members > bounds.max_members:
            raise FileFormatError(f"an archive may have {bounds.max_members:,} members; split this one")
        if member.is_folder:
            continue
        outcome = _read(member, is_wanted, seen, bounds, bounds.max_total_bytes - n_bytes)
        if outcome is not None:
            yield outcome
        if isinstance(outcome, ArchivedFile):
            n_bytes += len(outcome.data)


def plain_name(name: str) -> str:
    """A member's name as a relative path of plain steps.

    Raises
    ------
    FileFormatError : absolute, upwards, with a drive, a backslash or what cannot be printed, too long, or empty.
    """
    if not name.isprintable():
        raise FileFormatError("a member's name must be printable UTF-8; rename it")
    if len(name) > MAX_NAME:
        raise FileFormatError(f"a member's name may have {MAX_NAME:,} characters but has {len(name):,}; shorten it")
    if name.startswith("/") or "\\" in name or name[1:2] == ":":
        raise FileFormatError(
            "a member's name must be relative, with / between its steps; archive a folder, not a disk"
        )
    steps = [step for step in name.split("/") if step not in ("", ".")]
    if not steps or ".." in steps:
        raise FileFormatError("a member's name must stay within the archive; archive it from the folder above")
    return "/".join(steps)


def _read(
    member: Member, is_wanted: Callable[[str], bool], seen: set[str], bounds: ArchiveLimits, n_left: int
) -> ArchivedFile | RefusedMember | None:
    shown = member.name if member.name.isprintable() else ascii(member.name)
    try:
        name = plain_name(member.name)
        if any(step.startswith(".") or step == "__MACOSX" for step in name.split("/")):
            return None
        _check_kind(member, name)
        if not is_wanted(name):
            return None
        if name in seen:
            raise FileFormatError("a name may be used once in an archive but this one comes again; rename it")
        seen.add(name)
        return ArchivedFile(name, _content(member, bounds, n_left))
    except ArchiveError:
        raise
    except FileFormatError as error:
        return RefusedMember(shown[:MAX_NAME], f"{shown[:MAX_NAME]}: {error}")


def _check_kind(member: Member, name: str) -> None:
    if member.fault:
        raise FileFormatError(member.fault)
    if PurePosixPath(name).suffix.lower() in NESTED_SUFFIXES:
        raise FileFormatError("archives within an archive are not opened; unpack it first")


def _content(member: Member, bounds: ArchiveLimits, n_left: int) -> bytes:
    found = bytearray()
    for chunk in member.chunks():
        found += chunk
        if len(found) > n_left:
            raise ArchiveError(f"an archive may expand to {bounds.max_total_bytes:,} bytes; split this one")
        bounds.member.check_bytes(len(found))
    return bytes(found)
