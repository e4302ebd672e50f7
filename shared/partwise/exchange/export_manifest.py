"""The manifest beside an export: which files, of which meshes, labelled how, under which schema, by which model."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from itertools import chain
from pathlib import Path, PurePosixPath

from partwise.errors import FileFormatError, ParameterError
from partwise.exchange.described_json import load_json
from partwise.exchange.label_files import read_label_text
from partwise.exchange.labelled_mesh import LABEL_KINDS, check_sha256
from partwise.exchange.parts import PartEntry, PartTable
from partwise.io.atomic import write_atomically
from partwise.unlabelled import NO_CLASS

FORMAT = "partwise.export"
FORMAT_VERSION = 2
_READ_VERSIONS = (1, 2)  # 1 lacked what has a default
SEGMENTATIONS = ("confirmed", "refined", "predicted")
MESHES = ("working", "original")


@dataclass(frozen=True, slots=True)
class ManifestFile:
    """A file of the export: path relative to the manifest with forward slashes, and SHA-256 in hex."""

    path: str
    sha256: str

    def __post_init__(self) -> None:
        path = PurePosixPath(self.path)
        if not self.path or path.is_absolute() or ".." in path.parts or "\\" in self.path:
            raise ParameterError(f"a path must be relative, without .. or backslash, but is {self.path!r}; shorten it")
        check_sha256(self.sha256, f"the hash of {self.path}")


@dataclass(frozen=True, slots=True)
class ManifestShape:
    """One shape: its source key, its hashes and its files.

    mesh_hash : `TriMesh.content_hash` of the mesh that the labels belong to.
    source_hash : SHA-256 of the ingested source file.
    faces_per_part : part id → number of faces with it; −1 for unlabelled. Sums to `n_faces`.
    model_version : of predicted and refined labels, which may come from different models; None for confirmed ones.
    kind : one of `LABEL_KINDS`; "" where the export did not say.
    mesh : "working", or "original": the faces of the source file; "" where the export did not say.
    revision_ids : of confirmed labels: the revision on record, what that was moved from, and so on.
    agreement : share of the area in [0, 1] that survives the way from the mesh where the labels are on record to this
        one and back; None where this is that mesh.
    is_in_review : the labels wait for someone to look at them again.
    """

    source_key: str
    mesh_hash: str
    source_hash: str
    n_faces: int
    faces_per_part: dict[int, int]
    files: tuple[ManifestFile, ...]
    model_version: int | None = None
    kind: str = ""
    mesh: str = ""
    revision_ids: tuple[int, ...] = ()
    agreement: float | None = None
    is_in_review: bool = False

    def __post_init__(self) -> None:
        check_sha256(self.mesh_hash, f"mesh_hash of {self.source_key}")
        check_sha256(self.source_hash, f"source_hash of {self.source_key}")
        if self.kind and self.kind not in LABEL_KINDS:
            raise ParameterError(
                f"the kind of {self.source_key}'s labels must be one of {LABEL_KINDS} but is {self.kind!r}; choose one"
            )
        if self.mesh not in ("", *MESHES):
            raise ParameterError(f"labels must be on one of {MESHES} but {self.source_key}'s are on {self.mesh!r}")
        if min(self.faces_per_part.values(), default=0) < 0 or sum(self.faces_per_part.values()) != self.n_faces:
            raise ParameterError(
                f"faces_per_part of {self.source_key} must sum to {self.n_faces} faces but are {self.faces_per_part}; "
                "count unlabelled faces under −1"
            )


@dataclass(frozen=True, slots=True)
class ExportManifest:
    """Everything needed to know what an export is and to check that it is whole.

    segmentation : "confirmed", "refined" or "predicted".
    files : of the collection as a whole, such as one COCO file for all shapes.
    parameters : what shaped the files beyond the labels: format, points a shape, seed, …

    Raises
    ------
    ParameterError : unknown segmentation, no model where there must be one, parts that are no schema, or parts that a
        shape counts but the schema lacks.
    """

    partwise_version: str
    collection: str
    schema_version: int
    parts: tuple[PartEntry, ...]
    segmentation: str
    shapes: tuple[ManifestShape, ...]
    files: tuple[ManifestFile, ...] = ()
    parameters: dict[str, str | int | float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.segmentation not in SEGMENTATIONS:
            raise ParameterError(
                f"segmentation must be one of {SEGMENTATIONS} but is {self.segmentation!r}; choose one"
            )
        known = {*PartTable(self.schema_version, self.parts).ids, NO_CLASS}
        for shape in self.shapes:
            if (shape.model_version is None) != (self.segmentation == "confirmed"):
                raise ParameterError(
                    f"predicted and refined labels must name their model, confirmed ones none, but {shape.source_key} "
                    f"has {self.segmentation} labels of model {shape.model_version}"
                )
            if strangers := shape.faces_per_part.keys() - known:
                raise ParameterError(
                    f"{shape.source_key} has parts {sorted(strangers)} that the schema lacks; export under its version"
                )

    def to_json(self) -> str:
        """The manifest as indented JSON with a format name and version."""
        return json.dumps({"format": FORMAT, "format_version": FORMAT_VERSION, **asdict(self)}, indent=2) + "\n"


def write_manifest(path: Path | str, manifest: ExportManifest) -> None:
    """Writes the manifest; StoreError if that fails. Write it last, so that it vouches for files that are there."""
    write_atomically(path, manifest.to_json().encode())


def read_manifest(path: Path | str, data: bytes | None = None) -> ExportManifest:
    """Reads a manifest.

    Raises
    ------
    FileFormatError : missing, not JSON, not a manifest, of a newer version, or inconsistent.
    """
    text = read_label_text(path, data)
    try:
        document = load_json(text, "a manifest")
        found = document["format"], document["format_version"]
        if found[0] != FORMAT or found[1] not in _READ_VERSIONS:
            raise ValueError(f"its format is {found}")
        fields = {key: value for key, value in document.items() if key not in ("format", "format_version")}
        fields["parts"] = tuple(PartEntry(**part) for part in document["parts"])
        fields["shapes"] = tuple(_shape(shape) for shape in document["shapes"])
        fields["files"] = tuple(ManifestFile(**file) for file in document.get("files", ()))
        return ExportManifest(**fields)
    except (KeyError, TypeError, AttributeError, ValueError) as error:  # JSON's and our own errors are ValueErrors
        raise FileFormatError(
            f"{path}: a manifest must be {FORMAT} {FORMAT_VERSION} as partwise writes it but {error}; export again"
        ) from error


def damaged_files(manifest: ExportManifest, folder: Path) -> tuple[str, ...]:
    """Paths of files that are missing from `folder` or whose hash differs."""
    files: Iterable[ManifestFile] = chain(manifest.files, *(shape.files for shape in manifest.shapes))
    return tuple(
        file.path
        for file in files
        if not (folder / file.path).is_file() or file_sha256(folder / file.path) != file.sha256
    )


def file_sha256(path: Path) -> str:
    """SHA-256 of a file's bytes, hex."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _shape(fields: dict[str, object]) -> ManifestShape:
    faces_per_part = {int(part): count for part, count in fields["faces_per_part"].items()}  # type: ignore[attr-defined]
    files = tuple(ManifestFile(**file) for file in fields["files"])  # type: ignore[attr-defined]
    revision_ids: tuple[int, ...] = tuple(fields.get("revision_ids", ()))  # type: ignore[arg-type]
    converted = {"faces_per_part": faces_per_part, "files": files, "revision_ids": revision_ids}
    return ManifestShape(**{**fields, **converted})  # type: ignore[arg-type]
