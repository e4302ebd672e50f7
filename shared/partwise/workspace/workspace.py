"""Making and opening a workspace."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from partwise.config import CONFIG_FILE, Config, read_config
from partwise.errors import ConfigError
from partwise.io.atomic import write_atomically
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import Catalog
from partwise.store.open import create_catalog, open_array_store, open_catalog

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
    ConfigError : the path is a file, or a folder that holds other things.
    """
    if path.exists() and not path.is_dir():
        raise ConfigError(f"a workspace is a folder but {path} is a file; choose another path")
    config_path = path / CONFIG_FILE
    if not config_path.exists():
        if path.is_dir() and any(path.iterdir()):
            raise ConfigError(
                f"a new workspace needs an empty folder but {path} holds other files; choose another path"
            )
        write_atomically(config_path, INITIAL_CONFIG.encode())
    create_catalog(_database_url(path, read_config(config_path))).close()


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
    catalog = open_catalog(_database_url(path, config))
    try:
        yield Workspace(path, config, catalog, open_array_store(array_url), array_url)
    finally:
        catalog.close()


def migrate_workspace(path: Path) -> None:
    """Brings the catalog to the schema of this version of Partwise."""
    create_catalog(_database_url(path, read_config(path / CONFIG_FILE))).close()


def _database_url(path: Path, config: Config) -> str:
    prefix = "sqlite:///"
    url = config.stores.database_url
    if not url.startswith(prefix):
        return url
    return prefix + str((path / url.removeprefix(prefix)).resolve())


def _array_url(path: Path, config: Config) -> str:
    url = config.stores.array_url
    return url if "://" in url else str((path / url).resolve())
