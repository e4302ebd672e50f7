"""The Zarr array store is an `ArrayStore`, on a local folder and on fsspec."""

import uuid

import pytest

from partwise.store.open_arrays import open_array_store
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.array_store import ArrayStoreConformance


class TestLocalFolder(ArrayStoreConformance):
    """The `store` fixture is a folder."""


class TestFsspec(ArrayStoreConformance):
    @pytest.fixture
    def store(self) -> ZarrArrayStore:
        return open_array_store(f"memory://{uuid.uuid4().hex}/arrays")
