"""Open the array store at a URL. Apart from the catalog: processes that describe or draw have no use for SQL."""

from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import fsspec
from zarr.storage import FsspecStore, LocalStore

from partwise.errors import ConfigError, StoreError
from partwise.store.clock import utc_now
from partwise.store.objects import LocalObjects, RemoteObjects, storing
from partwise.store.zarr_store import ZarrArrayStore

CONNECT_S, READ_S = 5.0, 15.0
"""Seconds in which an object store must take a connection, and say something."""
ATTEMPTS = 2


def open_array_store(
    url: str, options: Mapping[str, Any] | None = None, clock: Callable[[], datetime] = utc_now
) -> ZarrArrayStore:
    """The array store at `url`: a folder's path, `file://…`, or what fsspec knows, such as `s3://bucket/prefix`.

    A local folder is made if its parent is there. `options` go to fsspec; the store is asked once whether it answers.

    Raises
    ------
    ConfigError : the URL's scheme is unknown.
    StoreError : the store cannot be reached or made, or its driver is not installed.
    """
    protocol, _, rest = url.rpartition("://")
    if protocol in ("", "file", "local"):
        return _local_store(Path(rest), clock)
    given = {**_driver_options(protocol), **(options or {})}
    try:
        file_system, root = fsspec.url_to_fs(url, **given)
    except ValueError as error:
        raise ConfigError(f"a store URL must be a folder or an fsspec URL but is {url!r}: {error}") from error
    except ImportError as error:
        raise StoreError(f"{protocol}:// needs a driver ({error}); install partwise[cloud]") from error
    _try_seldom(file_system)
    objects = RemoteObjects(file_system, root, url)
    objects.folders("")
    with storing(url, "its top folder"):
        zarr_store = FsspecStore.from_url(url, storage_options=given, read_only=True)
        _try_seldom(zarr_store.fs)
    return ZarrArrayStore(objects, zarr_store, url, clock)


def _local_store(root: Path, clock: Callable[[], datetime]) -> ZarrArrayStore:
    root = root.absolute()
    try:
        root.mkdir(exist_ok=True)
    except OSError as error:
        raise StoreError(f"an array store must be a folder in an existing one but {root} cannot be: {error}") from error
    return ZarrArrayStore(LocalObjects(root), LocalStore(root, read_only=True), str(root), clock)


def _driver_options(protocol: str) -> dict[str, Any]:
    """Seconds and attempts after which a store counts as unreachable: one that hangs is given up in about a minute. And
    no checksums of the driver's, which S3-compatible stores give for the whole object when a part was asked for: blocks
    have theirs.
    """
    if protocol != "s3":
        return {}
    checksums = dict.fromkeys(("request_checksum_calculation", "response_checksum_validation"), "when_required")
    patience = {"connect_timeout": CONNECT_S, "read_timeout": READ_S, "retries": {"total_max_attempts": ATTEMPTS}}
    return {"config_kwargs": {**patience, **checksums}}


def _try_seldom(file_system: Any) -> None:
    """s3fs tries again what its driver has given up, which a body that breaks off needs: as often, not five times."""
    if hasattr(file_system, "retries"):
        file_system.retries = ATTEMPTS
