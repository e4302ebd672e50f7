"""NPZ: mesh, labels and schema in numpy's own container, for scripts. Bit for bit the same for the same input.

| array | what |
|---|---|
| `vertices` | (n, 3) float64 |
| `faces` | (m, 3) uint32, counter-clockwise, in the mesh's order |
| `labels` | (m,) int32, part ids; −1 = unlabelled |
| `part_ids`, `part_names` | (k,) int32 and (k,) text: every part of the schema, with faces or without |
| `description` | text: JSON with format, version, mesh hash, schema (colours, glosses, parents) and provenance |

`numpy.load(path)` reads it; nothing in it needs pickle.

Source: numpy's NEP 1 (`numpy.lib.format`). Differs: dates and the system of origin in the zip are fixed, because
numpy's own writer depends on the platform (numpy issue 9439).
"""

import io
import json
import struct
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from partwise.errors import FileFormatError, LabelError, MeshError
from partwise.exchange.described_json import (
    load_json,
    parts_document,
    parts_from_document,
    provenance_document,
    provenance_from_document,
)
from partwise.exchange.label_files import read_label_bytes
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh, check_mesh_hash
from partwise.io.atomic import write_atomically
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh

FORMAT, FORMAT_VERSION = "partwise.labels", 1
_ARRAYS = ("vertices", "faces", "labels", "part_ids", "part_names", "description")
_DEFAULT_LIMITS = ReadLimits()
_UNIX = 3
_ENCRYPTED = 0x1
_MAX_EXPANSION = 1_000  # deflate cannot do more than 1,032
_MAX_LABEL = np.iinfo(np.int32).max


def write_npz(path: Path | str, described: DescribedMesh) -> None:
    """Writes mesh, labels and schema.

    Raises
    ------
    LabelError : a label does not fit int32.
    StoreError : the file cannot be written.
    """
    labels = described.labels
    if len(labels) and int(labels.max()) > _MAX_LABEL:
        raise LabelError(f"{path}: labels must be at most {_MAX_LABEL} but one is {int(labels.max())}; map them")
    description = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "mesh_hash": described.mesh.content_hash(),
        "schema": parts_document(described.parts),
        "provenance": provenance_document(described.provenance),
    }
    arrays = {
        "vertices": described.mesh.vertices.astype("<f8"),
        "faces": described.mesh.faces.astype("<u4"),
        "labels": labels.astype("<i4"),
        "part_ids": np.array(described.parts.ids, dtype="<i4"),
        "part_names": np.array(described.parts.names, dtype=np.str_),
        "description": np.array(json.dumps(description, ensure_ascii=False)),
    }
    write_atomically(path, _zipped(arrays))


def read_npz(path: Path | str, data: bytes | None = None, limits: ReadLimits = _DEFAULT_LIMITS) -> DescribedMesh:
    """What `write_npz` wrote.

    Raises
    ------
    FileFormatError : not such a file, truncated, pickled, or over a limit, packed or unpacked.
    LabelError : labels do not fit the mesh or the schema, or the mesh is not the one they were made on.
    """
    data = read_label_bytes(path, data)
    try:
        arrays = _unzipped(data, limits)
        description = load_json(str(arrays["description"]), "the description")
        if not isinstance(description, dict) or description.get("format") != FORMAT:
            raise FileFormatError(f"the description must be of format {FORMAT} but is not; export the file again")
        if description.get("format_version") != FORMAT_VERSION:
            raise FileFormatError(
                f"the format's version must be {FORMAT_VERSION} but is {description.get('format_version')!r}; "
                "read it with the Partwise that wrote it"
            )
        mesh = TriMesh(arrays["vertices"], arrays["faces"])
        labelled = LabelledMesh(mesh, arrays["labels"].astype(np.int64))
        described = DescribedMesh(
            labelled,
            parts_from_document(description.get("schema")),
            provenance_from_document(description.get("provenance")),
        )
        check_mesh_hash(mesh.content_hash(), str(description.get("mesh_hash")))
        return described
    except MeshError as error:
        raise FileFormatError(f"{path}: {error}") from error
    except (FileFormatError, LabelError) as error:
        raise type(error)(f"{path}: {error}") from error


def _zipped(arrays: dict[str, np.ndarray]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in arrays.items():
            member = zipfile.ZipInfo(f"{name}.npy")  # dated 1980
            member.create_system = _UNIX
            member.compress_type = zipfile.ZIP_DEFLATED
            content = io.BytesIO()
            np.lib.format.write_array(content, values, version=(1, 0), allow_pickle=False)
            archive.writestr(member, content.getvalue())
    return buffer.getvalue()


def _unzipped(data: bytes, limits: ReadLimits) -> dict[str, np.ndarray]:
    """The expected arrays, of kinds that they may be; others in the file are left alone."""
    try:
        contents = _members(data, limits)
    except FileFormatError:
        raise
    except (zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, RuntimeError, ValueError) as error:
        reason = " ".join(str(error).split())[:100]
        raise FileFormatError(f"an NPZ must be a zip archive but {reason}; is the file truncated?") from error
    arrays = {name: _array(content, name) for name, content in contents.items()}
    _check_kinds(arrays, limits)
    return arrays


def _members(data: bytes, limits: ReadLimits) -> dict[str, bytes]:
    """The bytes of each expected array's file."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {member.filename: member for member in archive.infolist()}
        missing = [name for name in _ARRAYS if f"{name}.npy" not in members]
        if missing:
            raise FileFormatError(
                f"an NPZ of labels must hold {', '.join(_ARRAYS)} but lacks {', '.join(missing)}; "
                "write it with `partwise export --format npz`"
            )
        wanted = {name: members[f"{name}.npy"] for name in _ARRAYS}
        for member in wanted.values():
            if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or member.flag_bits & _ENCRYPTED:
                raise FileFormatError(f"{member.filename} must be plain or deflated but is not; save it with numpy")
        _check_expansion(sum(member.file_size for member in wanted.values()), len(data), limits)
        return {name: archive.read(member) for name, member in wanted.items()}


def _check_expansion(n_unpacked: int, n_packed: int, limits: ReadLimits) -> None:
    limits.check_bytes(n_unpacked)
    if n_unpacked > _MAX_EXPANSION * n_packed:
        raise FileFormatError(
            f"an NPZ may unpack to {_MAX_EXPANSION} times its size but this makes {n_unpacked} bytes of {n_packed}; "
            "do not trust the file"
        )


def _array(content: bytes, name: str) -> np.ndarray:
    """An array whose header agrees with its bytes: a header alone can promise any amount of memory."""
    stream = io.BytesIO(content)
    try:
        version = np.lib.format.read_magic(stream)
        read_header: Any = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}[
            version
        ]
        shape, fortran, dtype = read_header(stream)
    except (ValueError, KeyError) as error:
        first_line = str(error).splitlines()[0]
        raise FileFormatError(
            f"array {name} must be in numpy's format but {first_line}; export the file again"
        ) from error
    if dtype.hasobject:
        raise FileFormatError(f"array {name} must hold numbers or text but is pickled; do not trust the file")
    n_promised, n_bytes = int(np.prod(shape, dtype=object)) * dtype.itemsize, len(content) - stream.tell()
    if n_promised != n_bytes or min(shape, default=0) < 0:
        raise FileFormatError(f"array {name} promises {n_promised} bytes but has {n_bytes}; is the file truncated?")
    if not n_bytes:
        return np.zeros(shape, dtype=dtype)
    return np.frombuffer(content, dtype=dtype, offset=stream.tell()).reshape(shape, order="F" if fortran else "C")


def _check_kinds(arrays: dict[str, np.ndarray], limits: ReadLimits) -> None:
    for name, kinds, n_dimensions in (
        ("vertices", "f", 2),
        ("faces", "iu", 2),
        ("labels", "iu", 1),
        ("description", "U", 0),
    ):
        values = arrays[name]
        if values.dtype.kind not in kinds or values.ndim != n_dimensions:
            raise FileFormatError(
                f"array {name} must have {n_dimensions} dimensions of kind {kinds} but is {values.shape} "
                f"{values.dtype}; export the file again"
            )
    limits.check_faces(len(arrays["faces"]))
    limits.check_vertices(len(arrays["vertices"]))
