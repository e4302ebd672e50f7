"""Typed arrays out of a glTF document: buffers, views, accessors."""

import base64
import binascii
from typing import Any

import numpy as np

from partwise.errors import FileFormatError

_COMPONENT_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class GltfAccessors:
    """The arrays of one glTF document, read on demand and bounds-checked.

    Raises
    ------
    FileFormatError : from every method, where the document points outside its data, at another file, or at compression.
    LookupError, TypeError, ValueError, OverflowError : where the document's own structure is broken; the caller names
        the file.
    """

    def __init__(self, document: dict[str, Any], binary_chunk: bytes) -> None:
        self._document = document
        self._binary_chunk = binary_chunk

    def count(self, index: int) -> int:
        """Records of accessor `index`, as it says."""
        return int(self._accessor(index)["count"])

    def read(self, index: int) -> np.ndarray:
        """Accessor `index` as a (count, columns) array of its component type, or float64 if it is normalised."""
        accessor = self._accessor(index)
        dtype = np.dtype(_COMPONENT_TYPES[accessor["componentType"]])
        n, n_columns = int(accessor["count"]), _COLUMNS[accessor["type"]]
        if "bufferView" not in accessor:  # glTF then means zeros, which no position or index array is
            raise FileFormatError(f"accessor {index} must have data but has none; export without compression")
        values = self._rows(accessor["bufferView"], accessor.get("byteOffset", 0), n, n_columns, dtype)
        if "sparse" in accessor:
            values = self._with_sparse(values, accessor["sparse"])
        if accessor.get("normalized") and dtype.kind != "f":
            return np.maximum(values / np.iinfo(dtype).max, -1.0)
        return values

    def _accessor(self, index: int) -> dict[str, Any]:
        accessors = self._document.get("accessors", [])
        if not 0 <= index < len(accessors):
            raise FileFormatError(f"accessor {index} is used but there are {len(accessors)}; export the file again")
        accessor: dict[str, Any] = accessors[index]
        if int(accessor["count"]) < 0:
            raise FileFormatError(f"accessor {index} must count records but counts {accessor['count']}; export again")
        return accessor

    def _rows(self, view_index: int, offset: int, n: int, n_columns: int, dtype: np.dtype) -> np.ndarray:
        view = self._document["bufferViews"][view_index]
        if "EXT_meshopt_compression" in view.get("extensions", {}):
            raise FileFormatError("geometry must be uncompressed but uses meshopt compression; export without it")
        row_bytes = n_columns * dtype.itemsize
        stride = int(view.get("byteStride", row_bytes))
        n_bytes = (n - 1) * stride + row_bytes if n else 0
        data = self._buffer(view["buffer"])
        start = int(view.get("byteOffset", 0)) + int(offset)
        end_of_view = int(view.get("byteOffset", 0)) + int(view["byteLength"])
        if start < 0 or stride < row_bytes or start + n_bytes > min(end_of_view, len(data)):
            raise FileFormatError(
                f"buffer view {view_index} must hold {n_bytes} bytes from {start} but ends at "
                f"{min(end_of_view, len(data))}; is the file truncated?"
            )
        if not n:
            return np.zeros((0, n_columns), dtype=dtype)
        raw = np.frombuffer(data, dtype=np.uint8, count=n_bytes, offset=start)
        strided = np.lib.stride_tricks.as_strided(raw, shape=(n, row_bytes), strides=(stride, 1), writeable=False)
        return np.ascontiguousarray(strided).view(dtype)

    def _buffer(self, index: int) -> bytes:
        uri = self._document["buffers"][index].get("uri")
        if uri is None:
            return self._binary_chunk
        if not uri.startswith("data:"):
            raise FileFormatError(f"a GLB file must hold its data itself but names {uri[:80]!r}; export self-contained")
        try:
            return base64.b64decode(uri.partition(",")[2], validate=True)
        except binascii.Error as error:
            raise FileFormatError(f"an embedded buffer must be base64 but {error}; export the file again") from error

    def _with_sparse(self, values: np.ndarray, sparse: dict[str, Any]) -> np.ndarray:
        n, where, what = int(sparse["count"]), sparse["indices"], sparse["values"]
        index_type = np.dtype(_COMPONENT_TYPES[where["componentType"]])
        rows = self._rows(where["bufferView"], where.get("byteOffset", 0), n, 1, index_type).ravel()
        new = self._rows(what["bufferView"], what.get("byteOffset", 0), n, values.shape[1], values.dtype)
        if n and int(rows.max()) >= len(values):
            raise FileFormatError(f"a sparse accessor replaces row {int(rows.max())} of {len(values)}; export it again")
        result = values.copy()
        result[rows] = new
        return result
