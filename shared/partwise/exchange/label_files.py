"""Reading label files: their text, from disk or store, with errors that name the file."""

from pathlib import Path

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.read import read_bytes


def read_label_bytes(path: Path | str, data: bytes | None) -> bytes:
    """`data`, or the file's bytes.

    Raises
    ------
    FileFormatError : missing, unreadable, empty, or as large as no label file is.
    """
    try:
        if data is None:
            data = read_bytes(Path(path))
        ReadLimits().check_bytes(len(data))
        if not data.strip():
            raise FileFormatError("a label file must have content but is empty; was the download cut off?")
    except FileFormatError as error:
        raise FileFormatError(f"{path}: {error}") from error
    return data


def read_label_text(path: Path | str, data: bytes | None) -> str:
    """As `read_label_bytes`, decoded from UTF-8 (a byte order mark is dropped).

    Raises
    ------
    FileFormatError : as above, or not UTF-8.
    """
    try:
        return read_label_bytes(path, data).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileFormatError(f"{path}: a label file must be UTF-8 text but {error}; convert it") from error
