"""Members of a zip archive, checked before and while they are read."""

import stat
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from partwise.errors import FileFormatError
from partwise.io.archive_limits import CHUNK, ArchiveError, ArchiveLimits
from partwise.io.limits import MIB

_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
"""Others need much memory to expand."""
_ENCRYPTED = 0x1
_LOCAL_HEADER = 30  # bytes, without name and extra field
_ENTRY = 46  # bytes in the directory, likewise
_MEAN_ENTRY = 512  # bytes that an honest directory has for each member, at most
_END = struct.Struct("<4s4H2LH")
_END64_LOCATOR = struct.Struct("<4sLQL")
_END64 = struct.Struct("<4sQ2H2L4Q")
_END_SIGNATURE, _END64_LOCATOR_SIGNATURE, _END64_SIGNATURE = b"PK\x05\x06", b"PK\x06\x07", b"PK\x06\x06"
_MAX_COMMENT = 1 << 16


@dataclass(slots=True)
class _Slack:
    """Bytes by which all members together may still expand further than each may by its size."""

    n_bytes: int = MIB


@dataclass(frozen=True, slots=True)
class ZipMember:
    """One entry of the directory. slack : shared by all of the archive."""

    archive: zipfile.ZipFile
    info: zipfile.ZipInfo
    limits: ArchiveLimits
    slack: _Slack

    @property
    def name(self) -> str:
        return self.info.orig_filename

    @property
    def is_folder(self) -> bool:
        return self.info.filename.endswith("/")

    @property
    def fault(self) -> str:
        kind = stat.S_IFMT(self.info.external_attr >> 16)
        if kind not in (0, stat.S_IFREG):
            return "only plain files are taken but this is a link or a device; archive what it points to"
        if self.info.flag_bits & _ENCRYPTED:
            return "a member must not be encrypted; archive it without a password"
        if self.info.compress_type not in _METHODS:
            return "a member must be stored or deflated; archive it with the usual method"
        return ""

    def chunks(self) -> Iterator[bytes]:
        n_beyond = -self.limits.max_ratio * self.info.compress_size
        try:
            with self.archive.open(self.info) as file:
                while chunk := file.read(CHUNK):
                    n_beyond += len(chunk)
                    if n_beyond > self.slack.n_bytes:
                        raise FileFormatError(
                            f"a member may expand {self.limits.max_ratio} times but this one expands further; "
                            "archive it anew"
                        )
                    yield chunk
            self.slack.n_bytes -= max(n_beyond, 0)  # not for a member that was refused, whose bytes nobody keeps
        except (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError) as error:
            raise FileFormatError("a member must be whole but is damaged; archive it anew") from error


def zip_members(path: Path, limits: ArchiveLimits) -> Iterator[ZipMember]:
    """The members in the order of the directory.

    Raises
    ------
    ArchiveError : damaged, more members than the limit, or members that overlap.
    """
    _check_directory(path, limits)
    try:
        with zipfile.ZipFile(path) as archive:
            _check_overlaps(archive)
            slack = _Slack()
            for info in archive.infolist():
                yield ZipMember(archive, info, limits, slack)
    except ArchiveError:
        raise
    except (zipfile.BadZipFile, NotImplementedError, struct.error, OSError, ValueError) as error:
        raise ArchiveError("a zip archive must be whole but is damaged; archive it anew") from error


def _check_overlaps(archive: zipfile.ZipFile) -> None:
    """Members that share bytes expand to what no archive of its size could hold."""
    end = 0
    for info in sorted(archive.infolist(), key=lambda each: each.header_offset):
        if info.header_offset < end:
            raise ArchiveError("members of an archive must not overlap but these do; archive the files anew")
        end = info.header_offset + _LOCAL_HEADER + info.compress_size
    if end > archive.start_dir:
        raise ArchiveError("members of an archive must not overlap its directory; archive the files anew")


def _check_directory(path: Path, limits: ArchiveLimits) -> None:
    """Bounds the directory by its size, before all of it is read: what it says of its length need not be true."""
    n_bytes = _directory_bytes(path)
    if n_bytes > limits.max_members * _MEAN_ENTRY + _ENTRY:
        raise ArchiveError(f"an archive may have {limits.max_members:,} members; split this one")


def _directory_bytes(path: Path) -> int:
    with path.open("rb") as file:
        n_file = file.seek(0, 2)
        n_tail = min(n_file, _END.size + _MAX_COMMENT + _END64_LOCATOR.size)
        file.seek(n_file - n_tail)
        tail = file.read(n_tail)
        at = tail.rfind(_END_SIGNATURE)
        if at < 0 or at + _END.size > n_tail:
            raise ArchiveError("a zip archive must have a directory but this has none; was the download cut off?")
        n_bytes = int(_END.unpack_from(tail, at)[5])
        if at < _END64_LOCATOR.size:
            return n_bytes
        signature, _, where, _ = _END64_LOCATOR.unpack_from(tail, at - _END64_LOCATOR.size)
        if signature != _END64_LOCATOR_SIGNATURE or where > n_file:
            return n_bytes
        # the reader takes the record right before the locator, wherever that says it is
        file.seek(n_file - n_tail + at - _END64_LOCATOR.size - _END64.size)
        found = file.read(_END64.size)
        is_record = len(found) == _END64.size and found.startswith(_END64_SIGNATURE)
        return max(n_bytes if n_bytes != 0xFFFF_FFFF else 0, int(_END64.unpack(found)[8])) if is_record else n_bytes
