"""Whole objects under keys, on a local folder or any fsspec file system: written atomically, listed, deleted.

A local object is written beside, synced and renamed, so a crash or a full disk leaves the previous state. What can be
made again is not synced: that would take longer than many a stage. Object stores replace whole objects by themselves.
"""

import errno
import os
import shutil
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, BinaryIO, Protocol

from partwise.errors import NotFoundError, StoreError

_PARTIAL = ".partial"


class Objects(Protocol):
    """Keys are safe (`checked_key`) when they get here."""

    def put(self, key: str, data: bytes) -> None: ...

    def put_unsynced(self, key: str, data: bytes) -> None:
        """As `put`, but whole only as long as the machine stays up: afterwards it may be gone or damaged."""
        ...

    def get(self, key: str) -> bytes: ...

    def exists(self, key: str) -> bool: ...

    def delete(self, key: str) -> None: ...

    def delete_many(self, keys: Sequence[str]) -> None:
        """As `delete` for each, in few requests."""
        ...

    def delete_folder(self, folder: str) -> None: ...

    def keys(self, folder: str) -> Sequence[str]:
        """Keys of all objects below a folder ("" is the root), sorted."""
        ...

    def folders(self, folder: str) -> Sequence[str]:
        """Names of the folders directly in a folder, sorted."""
        ...

    def sweep_unfinished(self, before: datetime) -> int:
        """Delete what killed writes left before a time; returns how many."""
        ...


class LocalObjects:
    """Objects as files in a folder."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def put(self, key: str, data: bytes) -> None:
        with storing(f"{self.root}", key):
            target = self._replace(key, data, _sync)
            _sync_folder(target.parent)

    def put_unsynced(self, key: str, data: bytes) -> None:
        with storing(f"{self.root}", key):
            self._replace(key, data)

    def _replace(self, key: str, data: bytes, finish: Callable[[BinaryIO], None] | None = None) -> Path:
        target = self.root / key
        partial = self.root / _PARTIAL / uuid.uuid4().hex
        self._make_folder(partial.parent)
        self._make_folder(target.parent)
        try:
            with partial.open("wb") as file:
                file.write(data)
                if finish is not None:
                    finish(file)
            partial.replace(target)
        except BaseException:
            partial.unlink(missing_ok=True)
            raise
        return target

    def _make_folder(self, folder: Path) -> None:
        """As mkdir -p, but durable: each new entry is synced in the folder that holds it."""
        if folder.is_dir():
            return
        if folder != self.root:
            self._make_folder(folder.parent)
        folder.mkdir(exist_ok=True)
        _sync_folder(folder.parent)

    def get(self, key: str) -> bytes:
        with storing(f"{self.root}", key):
            return (self.root / key).read_bytes()

    def exists(self, key: str) -> bool:
        return (self.root / key).is_file()

    def delete(self, key: str) -> None:
        with storing(f"{self.root}", key):
            (self.root / key).unlink(missing_ok=True)

    def delete_many(self, keys: Sequence[str]) -> None:
        for key in keys:
            self.delete(key)

    def delete_folder(self, folder: str) -> None:
        with storing(f"{self.root}", folder):
            if (self.root / folder).is_dir():
                shutil.rmtree(self.root / folder)

    def keys(self, folder: str) -> Sequence[str]:
        start = self.root / folder
        found = []
        for where, names, files in os.walk(start):
            names[:] = [name for name in names if not name.startswith(".")]
            found += [(Path(where) / file).relative_to(self.root).as_posix() for file in files]
        return sorted(found)

    def folders(self, folder: str) -> Sequence[str]:
        start = self.root / folder
        if not start.is_dir():
            return []
        return sorted(entry.name for entry in start.iterdir() if entry.is_dir() and not entry.name.startswith("."))

    def sweep_unfinished(self, before: datetime) -> int:
        folder = self.root / _PARTIAL
        if not folder.is_dir():
            return 0
        old = [file for file in folder.iterdir() if file.stat().st_mtime < before.timestamp()]
        for file in old:
            file.unlink(missing_ok=True)
        return len(old)


def _sync(file: BinaryIO) -> None:
    file.flush()
    os.fsync(file.fileno())


def _sync_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


class RemoteObjects:
    """Objects of an fsspec file system below `root`; `where` names the store in messages."""

    def __init__(self, file_system: Any, root: str, where: str) -> None:
        self._fs = file_system
        self._root = root.rstrip("/")
        self._where = where

    def put(self, key: str, data: bytes) -> None:
        with storing(self._where, key):
            self._fs.pipe_file(self._path(key), data)

    def put_unsynced(self, key: str, data: bytes) -> None:
        self.put(key, data)

    def get(self, key: str) -> bytes:
        with storing(self._where, key):
            return bytes(self._fs.cat_file(self._path(key)))

    def exists(self, key: str) -> bool:
        with storing(self._where, key):
            return bool(self._fs.isfile(self._path(key)))

    def delete(self, key: str) -> None:
        with storing(self._where, key):
            if self._fs.isfile(self._path(key)):
                self._fs.rm_file(self._path(key))

    def delete_many(self, keys: Sequence[str]) -> None:
        if not keys:
            return
        with storing(self._where, f"{keys[0]} and {len(keys) - 1:,} more"):
            try:
                self._fs.rm([self._path(key) for key in keys])
                return
            except FileNotFoundError:  # some file systems stop there, others take missing ones as deleted
                pass
        for key in keys:
            self.delete(key)

    def delete_folder(self, folder: str) -> None:
        with storing(self._where, folder or "its top folder"):
            if self._fs.exists(self._path(folder)):
                self._fs.rm(self._path(folder), recursive=True)

    def keys(self, folder: str) -> Sequence[str]:
        with storing(self._where, folder or "its top folder"):
            self._fs.invalidate_cache()
            found = self._fs.find(self._path(folder))
            return sorted(self._relative(path) for path in found)

    def folders(self, folder: str) -> Sequence[str]:
        with storing(self._where, folder or "its top folder"):
            self._fs.invalidate_cache()
            try:
                entries = self._fs.ls(self._path(folder), detail=True)
            except FileNotFoundError:
                return []
            return sorted(
                entry["name"].rstrip("/").rsplit("/", 1)[-1] for entry in entries if entry["type"] == "directory"
            )

    def sweep_unfinished(self, before: datetime) -> int:  # noqa: ARG002 # object stores show whole objects only
        return 0

    def _path(self, key: str) -> str:
        return f"{self._root}/{key}" if key else self._root

    def _relative(self, path: str) -> str:
        # file systems differ in whether the paths they list begin with a slash
        return path.lstrip("/").removeprefix(self._root.lstrip("/")).lstrip("/")


@contextmanager
def storing(where: str, key: str) -> Iterator[None]:
    """Turn what drivers raise into the project's errors, in one line with a remedy."""
    try:
        yield
    except (NotFoundError, StoreError):
        raise
    except (FileNotFoundError, NotADirectoryError, IsADirectoryError) as error:
        raise NotFoundError(f"there is no object {key!r} in the array store at {where}") from error
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            message = f"the array store at {where} has no room for {key}; free some space and run again"
            raise StoreError(message) from error
        raise StoreError(f"the array store at {where} refused {key}: {_line(error)}; may you write there?") from error
    except Exception as error:  # the drivers of object stores raise types of their own, unrelated to OSError
        raise StoreError(f"the array store at {where} failed at {key}: {_line(error)}; is it reachable?") from error


def _line(error: Exception) -> str:
    return next(iter(str(error).strip().splitlines()), type(error).__name__)
