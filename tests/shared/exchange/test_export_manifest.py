"""The manifest: consistent when made, the same when read, and able to tell when files changed."""

import dataclasses
import json

import pytest

from partwise.errors import FileFormatError, ParameterError
from partwise.exchange.export_manifest import (
    ExportManifest,
    ManifestFile,
    ManifestShape,
    damaged_files,
    file_sha256,
    read_manifest,
    write_manifest,
)
from partwise.exchange.parts import PartEntry

HASH = "0123456789abcdef" * 4
FILE = ManifestFile("chairs/1.seg", HASH)
WHOLE = ManifestFile("coco.json", HASH)
SHAPE = ManifestShape("1.off", HASH, HASH, 10, {0: 6, 2: 3, -1: 1}, (FILE,), 17, "refined")
PARTS = (PartEntry(0, "seat", "#ff0000"), PartEntry(2, "leg", "#00ff00", "what it stands on", 0))
MANIFEST = ExportManifest("0.1.0", "chairs", 3, PARTS, "refined", (SHAPE,), (WHOLE,), {"format": "coco", "seed": 7})


def test_round_trip(tmp_path):
    write_manifest(tmp_path / "manifest.json", MANIFEST)
    assert read_manifest(tmp_path / "manifest.json") == MANIFEST


def test_confirmed_labels_name_no_model():
    shape = dataclasses.replace(SHAPE, model_version=None)
    manifest = dataclasses.replace(MANIFEST, segmentation="confirmed", shapes=(shape,))
    assert read_manifest("m.json", manifest.to_json().encode()) == manifest


def test_the_first_version_is_still_read():
    """It had neither kinds, glosses and parents nor files of the collection and parameters."""
    document = json.loads(MANIFEST.to_json())
    document["format_version"] = 1
    for absent in ("files", "parameters"):
        del document[absent]
    del document["shapes"][0]["kind"]
    document["parts"] = [{"id": 0, "name": "seat", "colour": "#ff0000"}, {"id": 2, "name": "leg", "colour": "#00ff00"}]
    found = read_manifest("m.json", json.dumps(document).encode())
    assert (found.files, found.parameters, found.shapes[0].kind) == ((), {}, "")
    assert found.parts[1] == PartEntry(2, "leg", "#00ff00")


def test_json_names_its_format():
    assert json.loads(MANIFEST.to_json())["format"] == "partwise.export"


@pytest.mark.parametrize(
    ("original", "changes", "message"),
    [
        (PARTS[0], {"id": -1}, "id ≥ 0"),
        (PARTS[0], {"name": ""}, "a name"),
        (PARTS[0], {"colour": "#F00"}, "like #1f77b4"),
        (FILE, {"path": ""}, "relative"),
        (FILE, {"path": "/etc/passwd"}, "relative"),
        (FILE, {"path": "../a"}, "relative"),
        (FILE, {"path": "a\\b"}, "relative"),
        (FILE, {"sha256": HASH[1:]}, "SHA-256"),
        (SHAPE, {"mesh_hash": HASH.upper()}, "mesh_hash"),
        (SHAPE, {"source_hash": ""}, "source_hash"),
        (SHAPE, {"n_faces": 11}, "sum to 11"),
        (SHAPE, {"faces_per_part": {0: 11, 2: -1}}, "sum to 10"),
        (SHAPE, {"kind": "guessed"}, "kind of 1.off"),
        (MANIFEST, {"parts": (PARTS[1],)}, "parent of 'leg'"),
        (MANIFEST, {"segmentation": "guessed"}, "segmentation"),
        (MANIFEST, {"shapes": (dataclasses.replace(SHAPE, model_version=None),)}, "must name their model"),
        (MANIFEST, {"segmentation": "confirmed"}, "must name their model"),
        (MANIFEST, {"parts": PARTS[:1]}, r"parts \[2\] that the schema lacks"),
        (MANIFEST, {"parts": (*PARTS, PARTS[0])}, "distinct"),
    ],
)
def test_refuses(original, changes, message):
    with pytest.raises(ParameterError, match=message):
        dataclasses.replace(original, **changes)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"not json",
        b"[]",
        b"{}",
        MANIFEST.to_json().replace('"format_version": 2', '"format_version": 3').encode(),
        MANIFEST.to_json().replace("partwise.export", "other.export").encode(),
        MANIFEST.to_json().replace('"collection"', '"kollection"').encode(),
        MANIFEST.to_json().replace('"refined"', '"guessed"').encode(),
        MANIFEST.to_json().replace('"2": 3', '"two": 3').encode(),
    ],
)
def test_reading_refuses(data):
    with pytest.raises(FileFormatError, match=r"^m\.json: "):
        read_manifest("m.json", data)


def test_damage_is_found(tmp_path):
    for name in ("whole", "changed", "lost"):
        (tmp_path / name).write_text(name)
    files = tuple(ManifestFile(name, file_sha256(tmp_path / name)) for name in ("whole", "changed", "lost"))
    (tmp_path / "changed").write_text("otherwise")
    (tmp_path / "lost").unlink()
    manifest = dataclasses.replace(MANIFEST, shapes=(dataclasses.replace(SHAPE, files=files),))
    assert damaged_files(manifest, tmp_path) == ("coco.json", "changed", "lost")
