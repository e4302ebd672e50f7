"""Numbers in text files: lines to arrays, with errors that name the line.

Nobody vouches for a file, and a token takes many times its bytes once it is an object of its own: lines come one at a
time, and no more of a line is split than is asked for.
"""

from array import array
from collections.abc import Iterable, Iterator
from io import BytesIO
from itertools import chain

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import FileFormatError


def text_lines(data: bytes, comment: bytes | None = b"#") -> Iterator[tuple[int, bytes]]:
    """Lines that hold something once comments are cut, stripped, and their numbers in the file from 1."""
    if b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    comment = comment if comment and comment in data else None
    for number, line in enumerate(BytesIO(data), start=1):
        stripped = (line.partition(comment)[0] if comment else line).strip()
        if stripped:
            yield number, stripped


def parse_points(lines: Iterable[bytes], what: str) -> Float[np.ndarray, "n 3"]:
    """First three numbers of each line, (n, 3) float64; further columns (normals, colours) are left out.

    Raises
    ------
    FileFormatError : a line has fewer than three columns or one that is no number; `what` names the lines.
    """
    rows = _first_three(lines, what)
    first = next(rows, None)
    if first is None:
        return np.zeros((0, 3))
    try:
        return np.loadtxt(chain([first], rows), dtype=np.float64, comments=None, ndmin=2)
    except FileFormatError:
        raise
    except ValueError as error:
        raise FileFormatError(f"{what} must be three numbers each but {_one_line(error)}; is it damaged?") from error


def _first_three(lines: Iterable[bytes], what: str) -> Iterator[bytes]:
    for line in lines:
        columns = line.split(None, 3)[:3]
        if len(columns) < 3:  # a blank one would be passed over, and all after it be counted wrong
            raise FileFormatError(f"{what} must be three numbers each but one has {len(columns)}; is it damaged?")
        yield b" ".join(columns)


def parse_integers(tokens: Iterable[bytes], what: str) -> Int[np.ndarray, " n"]:
    """Whole numbers, (n,) int64.

    Raises
    ------
    FileFormatError : a token is no whole number or does not fit 64 bits; `what` names the tokens.
    """
    return np.array(whole_numbers(tokens, what), dtype=np.int64)


def whole_numbers(tokens: Iterable[bytes], what: str) -> "array[int]":
    """As `parse_integers`, for a few numbers at a time."""
    try:
        return array("q", map(int, tokens))
    except (ValueError, OverflowError) as error:
        raise FileFormatError(f"{what} must be whole numbers but {_one_line(error)}; is it damaged?") from error


def format_rows(prefix: str, rows: np.ndarray) -> str:
    """One line per row, values in Python's shortest exact form, each line starting with `prefix`."""
    return "".join(f"{prefix}{' '.join(map(repr, row))}\n" for row in rows.tolist())


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]
