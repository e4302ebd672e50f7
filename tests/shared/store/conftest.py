"""Fixtures of the stores' tests."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from partwise.store.open import create_catalog
from partwise.store.sql_catalog import SqlCatalog

pytest.register_assert_rewrite("partwise.testing.array_store", "partwise.testing.catalog")


@pytest.fixture
def catalog(tmp_path: Path) -> Iterator[SqlCatalog]:
    with create_catalog(f"sqlite:///{tmp_path}/catalog.sqlite") as catalog:
        yield catalog
