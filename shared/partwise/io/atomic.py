"""Files that appear whole or not at all."""

import os
import secrets
from contextlib import suppress
from pathlib import Path

from partwise.errors import StoreError


def write_atomically(path: Path | str, data: bytes) -> None:
    """Writes to a new file beside the target, flushes it to disk, then renames it over the target.

    A crash or a full disk leaves the old file, if there was one, as it was. Missing folders are made.

    Raises
    ------
    StoreError : the disk is full, the folder is read-only or the path is a folder.
    """
    target = Path(path)
    # Opened by us, not by tempfile, so that the file gets the user's umask instead of 0600.
    partial = target.with_name(f".{target.name}.{secrets.token_hex(6)}.partial")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with partial.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(target)
    except OSError as error:
        with suppress(OSError):  # where the folder is a file, there is nothing to take away either
            partial.unlink()
        raise StoreError(
            f"{target}: cannot be written: {error.strerror or error}; free space or choose another folder"
        ) from error
