"""PLY as the format sees it: elements with scalar and list properties, ASCII or binary of either byte order.

A list property whose lengths are all equal is read in one go; other files are walked record by record.
"""

from array import array
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.text import text_lines

_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"int64": "i8", "uint64": "u8", "float": "f4", "double": "f8", "float32": "f4", "float64": "f8"},
}
_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_MAX_HEADER_BYTES = 1 << 20
_MAX_DIGITS = 18  # of a count; it then fits 64 bits


@dataclass(frozen=True, slots=True)
class PlyProperty:
    """A column: numpy type code of its values, and of the length before them if it is a list."""

    name: str
    value_type: str
    length_type: str | None = None


@dataclass(frozen=True, slots=True)
class PlyElement:
    """A table: its name, number of records and columns."""

    name: str
    n_records: int
    properties: tuple[PlyProperty, ...]


@dataclass(frozen=True, slots=True)
class PlyHeader:
    """What stands before the data; `byte_order` is "<", ">" or "" for ASCII."""

    byte_order: str
    elements: tuple[PlyElement, ...]
    n_bytes: int


@dataclass(frozen=True, slots=True, eq=False)
class PlyList:
    """A list property: lengths (n,) int64 and all values one after another."""

    lengths: Int[np.ndarray, " n"]
    values: np.ndarray


PlyTable = dict[str, np.ndarray | PlyList]


def parse_header(data: bytes) -> PlyHeader:
    """Reads the header.

    Raises
    ------
    FileFormatError : wrong magic, no end_header, or a line that does not fit.
    """
    if data[:3] != b"ply" or data[3:4] not in (b"\n", b"\r"):
        raise FileFormatError(
            f"a PLY file must start with a line ply but starts with {data[:8]!r}; is the suffix right?"
        )
    end = data.find(b"end_header", 0, _MAX_HEADER_BYTES)
    if end < 0:
        raise FileFormatError("a PLY header must close with end_header but does not; is the file truncated?")
    newline = end + len(b"end_header")
    n_bytes = newline + (2 if data[newline : newline + 2] == b"\r\n" else 1)
    byte_order: str | None = None
    elements: list[tuple[str, int, list[PlyProperty]]] = []
    for line in data[3:end].decode("latin-1").splitlines():
        match line.split():
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", name, "1.0"] if name in _BYTE_ORDERS:
                byte_order = _BYTE_ORDERS[name]
            case ["element", name, count] if count.isdecimal() and len(count) <= _MAX_DIGITS:
                elements.append((name, int(count), []))
            case ["property", "list", length, value, name] if elements and _TYPES.keys() >= {length, value}:
                elements[-1][2].append(PlyProperty(name, _TYPES[value], _TYPES[length]))
            case ["property", value, name] if elements and value in _TYPES:
                elements[-1][2].append(PlyProperty(name, _TYPES[value]))
            case _:
                raise FileFormatError(f"a PLY header must hold known lines but has {line[:80]!r}; is it damaged?")
    if byte_order is None:
        raise FileFormatError("a PLY header must have a format line but has none; is it damaged?")
    return PlyHeader(byte_order, tuple(PlyElement(name, n, tuple(p)) for name, n, p in elements), n_bytes)


def parse_elements(data: bytes, header: PlyHeader, limits: ReadLimits) -> dict[str, PlyTable]:
    """Every element's columns, by name.

    Raises
    ------
    FileFormatError : the data end before the header's counts are met, hold what is no number, or too many numbers.
    """
    if header.byte_order:
        return _parse_binary(data, header)
    return _parse_ascii(data, header, limits)


def _truncated(element: PlyElement) -> FileFormatError:
    return FileFormatError(
        f"the header promises {element.n_records} records of {element.name} but the data end before; "
        "is the file truncated?"
    )


def _parse_binary(data: bytes, header: PlyHeader) -> dict[str, PlyTable]:
    tables, offset = {}, header.n_bytes
    for element in header.elements:
        smallest = sum(np.dtype(p.length_type or p.value_type).itemsize for p in element.properties)
        if element.n_records * smallest > len(data) - offset:  # before any memory is taken for a count that is a lie
            raise _truncated(element)
        lengths = _first_lengths(data, offset, element, header.byte_order)
        uniform = _read_uniform(data, offset, element, header.byte_order, lengths)
        if uniform is None:
            uniform = _read_record_by_record(data, offset, element, header.byte_order)
        tables[element.name], offset = uniform
    return tables


def _first_lengths(data: bytes, offset: int, element: PlyElement, order: str) -> dict[str, int]:
    """Length of each list in the element's first record."""
    lengths: dict[str, int] = {}
    if not element.n_records:
        return {p.name: 0 for p in element.properties if p.length_type}
    for p in element.properties:
        n = 1
        if p.length_type:
            n, offset = _read_length(data, offset, order + p.length_type, element)
            lengths[p.name] = n
        offset += n * np.dtype(p.value_type).itemsize
    if offset > len(data):
        raise _truncated(element)
    return lengths


def _read_length(data: bytes, offset: int, dtype: str, element: PlyElement) -> tuple[int, int]:
    size = np.dtype(dtype).itemsize
    if offset + size > len(data):
        raise _truncated(element)
    n = np.frombuffer(data, dtype, 1, offset)[0]
    if not 0 <= n < np.inf:  # a float may be NaN, which fails this too
        raise FileFormatError(f"a list of {element.name} must have a length ≥ 0 but has {n}; is the file damaged?")
    return int(n), offset + size


def _read_uniform(
    data: bytes, offset: int, element: PlyElement, order: str, lengths: dict[str, int]
) -> tuple[PlyTable, int] | None:
    """The element as one structured array if every list is as long as in the first record, else None."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for k, p in enumerate(element.properties):
        if p.length_type:
            fields += [(f"length{k}", order + p.length_type), (f"value{k}", order + p.value_type, (lengths[p.name],))]
        else:
            fields.append((f"value{k}", order + p.value_type))
    record = np.dtype(fields)
    end = offset + record.itemsize * element.n_records
    if end > len(data):
        return None
    rows = np.frombuffer(data, record, element.n_records, offset)
    table: PlyTable = {}
    for k, p in enumerate(element.properties):
        if p.length_type is None:
            table[p.name] = rows[f"value{k}"]
            continue
        if (rows[f"length{k}"] != lengths[p.name]).any():
            return None
        table[p.name] = PlyList(rows[f"length{k}"].astype(np.int64), rows[f"value{k}"].ravel())
    return table, end


def _read_record_by_record(data: bytes, offset: int, element: PlyElement, order: str) -> tuple[PlyTable, int]:
    lengths = [array("q") for _ in element.properties]
    values = [bytearray() for _ in element.properties]
    for _ in range(element.n_records):
        for k, p in enumerate(element.properties):
            n = 1
            if p.length_type:
                n, offset = _read_length(data, offset, order + p.length_type, element)
                lengths[k].append(n)
            end = offset + n * np.dtype(p.value_type).itemsize
            if end > len(data):
                raise _truncated(element)
            values[k] += data[offset:end]
            offset = end
    table: PlyTable = {}
    for k, p in enumerate(element.properties):
        column = np.frombuffer(values[k], order + p.value_type)
        table[p.name] = PlyList(np.array(lengths[k], dtype=np.int64), column) if p.length_type else column
    return table, offset


def _parse_ascii(data: bytes, header: PlyHeader, limits: ReadLimits) -> dict[str, PlyTable]:
    lines = (line for _, line in text_lines(data[header.n_bytes :], comment=None))
    return {
        element.name: _ascii_table(islice(lines, element.n_records), element, limits) for element in header.elements
    }


def _ascii_table(lines: Iterable[bytes], element: PlyElement, limits: ReadLimits) -> PlyTable:
    """Columns of an element whose records are a line each. Values pass through float64, exact below 2^53."""
    numbers, counts = array("d"), array("q")
    for line in lines:
        tokens = line.split(None, limits.max_values - len(numbers))
        if len(numbers) + len(tokens) > limits.max_values:
            raise FileFormatError(
                f"records of {element.name} may have {limits.max_values} numbers in all but have more; "
                "drop what is not needed or raise max_faces"
            )
        try:
            numbers.extend(map(float, tokens))
        except ValueError as error:
            why = f"records of {element.name} must be numbers but {error}; is the file damaged?"
            raise FileFormatError(why) from error
        counts.append(len(tokens))
    if len(counts) < element.n_records:
        raise _truncated(element)
    flat, n_tokens = np.array(numbers, dtype=np.float64), np.array(counts, dtype=np.int64)
    row_end = np.cumsum(n_tokens)
    cursor = row_end - n_tokens
    table: PlyTable = {}
    for p in element.properties:
        lengths = np.ones(element.n_records, dtype=np.int64)
        if p.length_type:
            if (cursor >= row_end).any():
                raise _truncated(element)
            stated = flat[cursor]
            cursor = cursor + 1
            if not ((stated >= 0) & (stated <= row_end - cursor)).all():  # NaN fails this too
                raise _truncated(element)
            lengths = stated.astype(np.int64)
        if (cursor + lengths > row_end).any():
            raise _truncated(element)
        step = np.arange(int(lengths.sum())) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        values = flat[np.repeat(cursor, lengths) + step]
        table[p.name] = PlyList(lengths, values) if p.length_type else values
        cursor = cursor + lengths
    return table
