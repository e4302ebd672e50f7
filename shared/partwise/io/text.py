"""Numbers in text files: lines to arrays, with errors that name the line."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import FileFormatError


def numbered_lines(data: bytes, comment: bytes = b"#") -> tuple[list[bytes], list[int]]:
    """Lines that hold something once comments are cut, stripped, and their numbers in the file from 1."""
    lines = data.splitlines()
    if comment in data:
        lines = [line.partition(comment)[0] for line in lines]
    stripped = [line.strip() for line in lines]
    numbers = [number for number, line in enumerate(stripped, start=1) if line]
    return [line for line in stripped if line], numbers


def parse_points(lines: Sequence[bytes], what: str) -> Float[np.ndarray, "n 3"]:
    """First three numbers of each line, (n, 3) float64; further columns (normals, colours) are left out.

    Raises
    ------
    FileFormatError : a line has fewer than three columns or one that is no number; `what` names the lines.
    """
    if not lines:
        return np.zeros((0, 3))
    try:
        return np.loadtxt(lines, dtype=np.float64, usecols=(0, 1, 2), comments=None, ndmin=2)
    except (ValueError, IndexError) as error:
        raise FileFormatError(f"{what} must be three numbers each but {_one_line(error)}; is it damaged?") from error


def parse_integers(tokens: Sequence[bytes], what: str) -> Int[np.ndarray, " n"]:
    """Whole numbers, (n,) int64.

    Raises
    ------
    FileFormatError : a token is no whole number or does not fit 64 bits; `what` names the tokens.
    """
    try:
        return np.array(list(map(int, tokens)), dtype=np.int64)
    except (ValueError, OverflowError) as error:
        raise FileFormatError(f"{what} must be whole numbers but {_one_line(error)}; is it damaged?") from error


def format_rows(prefix: str, rows: np.ndarray) -> str:
    """One line per row, values in Python's shortest exact form, each line starting with `prefix`."""
    return "".join(f"{prefix}{' '.join(map(repr, row))}\n" for row in rows.tolist())


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]
