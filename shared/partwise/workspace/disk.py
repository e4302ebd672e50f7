"""What is left of the disk that the array store is on."""

import shutil
from pathlib import Path


def free_bytes(array_url: str) -> int | None:
    """None where the store is no folder of this machine."""
    folder = Path(array_url.removeprefix("file://"))
    return shutil.disk_usage(folder).free if folder.is_dir() else None
