"""Many objects of a file system are deleted in one request, whatever the system thinks of missing ones."""

import uuid
from collections.abc import Sequence

import pytest
from fsspec.implementations.memory import MemoryFileSystem

from partwise.errors import StoreError
from partwise.store.objects import RemoteObjects

KEYS = [f"staging/a/{number}" for number in range(3)]


class Watched(MemoryFileSystem):
    """Notes its deletions. With `is_strict` it refuses a list with a path that is not there, as some systems do."""

    cachable = False

    def __init__(self, *, is_strict: bool = False) -> None:
        super().__init__()
        self.is_strict = is_strict
        self.n_bulk = self.n_single = 0

    def rm(self, path: Sequence[str], recursive: bool = False, maxdepth: int | None = None) -> None:
        self.n_bulk += 1
        if self.is_strict and not all(self.exists(each) for each in path):
            raise FileNotFoundError(path)
        for each in path:
            if self.exists(each):
                super().rm_file(each)

    def rm_file(self, path: str) -> None:
        self.n_single += 1
        super().rm_file(path)


def objects_of(files: Watched) -> RemoteObjects:
    objects = RemoteObjects(files, f"/{uuid.uuid4().hex}", "memory")
    for key in KEYS:
        objects.put(key, b"x")
    return objects


def test_many_are_one_request() -> None:
    files = Watched()
    objects = objects_of(files)
    objects.delete_many([*KEYS[:2], "staging/a/gone"])
    assert (list(objects.keys("staging")), files.n_bulk, files.n_single) == (KEYS[2:], 1, 0)


def test_none_are_no_request() -> None:
    files = Watched()
    objects_of(files).delete_many([])
    assert files.n_bulk == 0


def test_a_missing_one_does_not_keep_the_others() -> None:
    files = Watched(is_strict=True)
    objects = objects_of(files)
    objects.delete_many([*KEYS[:2], "staging/a/gone"])
    assert (list(objects.keys("staging")), files.n_single) == (KEYS[2:], 2)


def test_a_store_that_refuses_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    files = Watched()
    objects = objects_of(files)

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError("no")

    monkeypatch.setattr(files, "rm", refuse)
    with pytest.raises(StoreError, match="staging/a/0 and 2 more"):
        objects.delete_many(KEYS)
