"""Members of a gzipped tar archive, read once from front to back."""

import gzip
import tarfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from partwise.io.archive_limits import CHUNK, ArchiveError, ArchiveLimits
from partwise.io.limits import MIB

_DAMAGES = (tarfile.TarError, zlib.error, EOFError, OSError, ValueError, OverflowError, RecursionError)
# RecursionError : `tarfile` reads a name that a header has for the next one by calling itself
HEADER_BYTES = MIB
"""That what precedes a member may take: names and notes may be of any length in a tar, and are read as a whole."""


class _Expanding:
    """The expanded archive as a file that `tarfile` reads, which counts what it hands out.

    n_allowed : bytes that may be read until the next member.
    """

    def __init__(self, compressed: BinaryIO, expanded: gzip.GzipFile, limits: ArchiveLimits) -> None:
        self._compressed = compressed
        self._expanded = expanded
        self._limits = limits
        self._n_read = 0
        self.n_allowed = HEADER_BYTES

    def read(self, size: int) -> bytes:
        data = self._expanded.read(size)
        self._n_read += len(data)
        self.n_allowed -= len(data)
        max_ratio, max_bytes = self._limits.max_ratio, self._limits.max_total_bytes
        if self._n_read > MIB + max_ratio * self._compressed.tell():
            raise ArchiveError(f"an archive may expand {max_ratio} times but this one expands further; archive it anew")
        if self._n_read > MIB + max_bytes:
            raise ArchiveError(f"an archive may expand to {max_bytes:,} bytes but this one goes on; split it")
        if self.n_allowed < 0:
            raise ArchiveError("a member's header may have a mebibyte but one here has more; archive anew")
        return data

    def drain(self) -> None:
        """Reads on to the end, where the checksum is."""
        self.n_allowed = 2 * CHUNK
        while self.read(CHUNK):
            self.n_allowed = 2 * CHUNK


@dataclass(frozen=True, slots=True)
class TarMember:
    """The member that the archive stands at."""

    archive: tarfile.TarFile
    info: tarfile.TarInfo

    @property
    def name(self) -> str:
        return self.info.name

    @property
    def is_folder(self) -> bool:
        return self.info.isdir()

    @property
    def fault(self) -> str:
        if self.info.isfile() and not self.info.issparse():
            return ""
        return "only plain files are taken but this is a link, a device or has holes; archive what it points to"

    def chunks(self) -> Iterator[bytes]:
        try:
            file = self.archive.extractfile(self.info)
            while file is not None and (chunk := file.read(CHUNK)):
                yield chunk
        except ArchiveError:
            raise
        except _DAMAGES as error:  # what follows cannot be read either
            raise _damaged() from error


def tar_members(path: Path, limits: ArchiveLimits) -> Iterator[TarMember]:
    """The members in their order; each must be read before the next is asked for.

    Raises
    ------
    ArchiveError : damaged, a header without end, or an expansion that no honest archive has.
    """
    try:
        with path.open("rb") as compressed, gzip.GzipFile(fileobj=compressed) as expanded:
            source = _Expanding(compressed, expanded, limits)
            with tarfile.open(fileobj=source, mode="r|", errorlevel=2) as archive:  # type: ignore[call-overload] # reads only
                n_before = 0
                while True:
                    source.n_allowed = n_before + HEADER_BYTES
                    info = archive.next()
                    if info is None:
                        break
                    archive.members.clear()  # it would keep all that it has seen
                    n_before = 0 if info.size < 0 else info.size
                    source.n_allowed = n_before + HEADER_BYTES
                    yield TarMember(archive, info)
            source.drain()
    except ArchiveError:
        raise
    except _DAMAGES as error:
        raise _damaged() from error


def _damaged() -> ArchiveError:
    return ArchiveError("a tar.gz archive must be whole but is damaged; archive it anew")
