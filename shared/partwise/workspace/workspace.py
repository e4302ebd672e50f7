"""Making and opening a workspace."""

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from partwise.config import CONFIG_FILE, DATABASE_VARIABLE, STORE_VARIABLE, Config, read_config
from partwise.errors import ConfigError, LabelError, StoreError
from partwise.io.atomic import write_atomically
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import Catalog
from partwise.store.open import create_catalog, open_catalog
from partwise.store.open_arrays import open_array_store
from partwise.store.records import Collection

INITIAL_CONFIG = """\
# Where things are and how they are computed. Every key is explained in docs/configuration.md; what is left out has its
# default. Collections, parts and people are rows in the catalog.

[stores]
database_url = "sqlite:///catalog.sqlite"
array_url = "arrays"
"""


@dataclass(frozen=True, slots=True, eq=False)
class Workspace:
    """An open workspace. `array_url` is absolute, for workers to open the same array store."""

    path: Path
    config: Config
    catalog: Catalog
    arrays: ArrayStore
    array_url: str


def init_workspace(path: Path) -> None:
    """Makes the folder, `partwise.toml` and an empty catalog. A workspace that is already there is left as it is.

    Raises
    ------
    ConfigError : the path is a file, or a folder that holds other things; or a store's URL is wrong.
    StoreError : a store cannot be reached or written. Then a new workspace is not left behind half-made.
    """
    with _made_whole(path):
        pass


def init_collection(path: Path, name: str, part_names: Sequence[str], settings: Mapping[str, Any]) -> Collection:
    """As `init_workspace`, with a new collection in it: both or neither.

    Raises
    ------
    ConflictError : the workspace has a collection of this name.
    LabelError : no part, or a part name that is empty, too long or given twice.
    ParameterError : the collection's name is empty or has spaces around it.
    """
    if not part_names:
        raise LabelError(f"a collection needs at least one part but {name!r} has none; name them in order")
    with _made_whole(path) as catalog:
        return catalog.create_collection(name, part_names, settings)


@contextmanager
def open_workspace(path: Path) -> Iterator[Workspace]:
    """Opens both stores and closes them at the end of the block.

    Raises
    ------
    ConfigError : not a workspace, or `partwise.toml` is wrong.
    StoreError : a store cannot be reached, or the catalog needs `partwise migrate`.
    """
    config = read_config(path / CONFIG_FILE)
    array_url = _array_url(path, config)
    with _naming_the_key(path, "database_url", DATABASE_VARIABLE):
        catalog = open_catalog(_database_url(path, config))
    try:
        with _naming_the_key(path, "array_url", STORE_VARIABLE):
            arrays = open_array_store(array_url)
        yield Workspace(path, config, catalog, arrays, array_url)
    finally:
        catalog.close()


def migrate_workspace(path: Path) -> None:
    """Brings the catalog to the schema of this version of Partwise.

    Raises
    ------
    ConfigError : not a workspace, or `partwise.toml` is wrong.
    NotFoundError : the catalog is gone; an empty one in its place would hide that.
    StoreError : it cannot be reached or written, or a newer Partwise made it.
    """
    url = _database_url(path, read_config(path / CONFIG_FILE))
    with _naming_the_key(path, "database_url", DATABASE_VARIABLE):
        try:
            open_catalog(url).close()
        except StoreError:  # an older schema; any other trouble comes up again
            create_catalog(url).close()


@contextmanager
def _made_whole(path: Path) -> Iterator[Catalog]:
    """The catalog of a workspace, which is made if it is not there and unmade if the block fails."""
    if path.exists() and not path.is_dir():
        raise ConfigError(f"a workspace is a folder but {path} is a file; choose another path")
    was_there, is_new = path.exists(), not (path / CONFIG_FILE).exists()
    if is_new and was_there and any(path.iterdir()):
        raise ConfigError(f"a new workspace needs an empty folder but {path} holds other files; choose another path")
    try:
        if is_new:
            write_atomically(path / CONFIG_FILE, INITIAL_CONFIG.encode())
        config = read_config(path / CONFIG_FILE)
        with _naming_the_key(path, "array_url", STORE_VARIABLE):
            open_array_store(_array_url(path, config))
        with _naming_the_key(path, "database_url", DATABASE_VARIABLE):
            catalog = create_catalog(_database_url(path, config))
        with catalog:
            yield catalog
    except BaseException:
        if is_new:
            _unmake(path, keep_folder=was_there)
        raise


def _unmake(path: Path, keep_folder: bool) -> None:
    """Takes away what a failed `init` put into an empty folder; anything else in there stays, and its folder."""
    for name in (CONFIG_FILE, *(f"catalog.sqlite{ending}" for ending in ("", "-wal", "-shm", "-journal"))):
        (path / name).unlink(missing_ok=True)
    for folder in (path / "arrays", *(() if keep_folder else (path,))):
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


@contextmanager
def _naming_the_key(path: Path, key: str, variable: str) -> Iterator[None]:
    """Says of a wrong URL where it was written."""
    try:
        yield
    except ConfigError as error:
        where = f"environment variable {variable}" if os.environ.get(variable) else f"{path / CONFIG_FILE}"
        raise ConfigError(f"{where}: [stores] {key}: {error}") from error


def _database_url(path: Path, config: Config) -> str:
    prefix = "sqlite:///"
    url = config.stores.database_url
    if not url.startswith(prefix):
        return url
    return prefix + str((path / url.removeprefix(prefix)).resolve())


def _array_url(path: Path, config: Config) -> str:
    url = config.stores.array_url
    return url if "://" in url else str((path / url).resolve())
