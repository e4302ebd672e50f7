"""An export as an archive: what the folder would have, until it expires."""

import io
import zipfile
from datetime import timedelta

import numpy as np
import pytest

from partwise.errors import NotFoundError
from partwise.store.large_objects import read_chunks
from partwise.store.records import RevisionKind
from partwise.workspace import export_archive as module
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export_archive import export_archive, find_export
from partwise.workspace.labelling import commit_labels

LABELS = np.array([1, 1, 2, 0], dtype=np.uint16)


@pytest.fixture
def confirmed(filled):
    filled.preprocessed()
    for key in ("a.off", "sub/c.off"):
        commit_labels(filled.workspace, filled.collection, filled.shape(key), LABELS, RevisionKind.HUMAN, "ann")
    return filled


def export(filled):
    return export_archive(filled.workspace, filled.collection, Segmentation.CONFIRMED, ExportFormat.SEG)


def test_the_archive_has_the_exports_files(confirmed) -> None:
    made, report = export(confirmed)
    found = find_export(confirmed.workspace, confirmed.collection.id, made.name)
    archive = zipfile.ZipFile(io.BytesIO(b"".join(read_chunks(confirmed.workspace.arrays, found))))
    assert sorted(archive.namelist()) == ["a.seg", "manifest.json", "sub/c.seg"]
    assert (archive.testzip(), report.n_written) == (None, 2)


def test_an_export_is_found_in_its_collection_only(confirmed) -> None:
    made, _ = export(confirmed)
    with pytest.raises(NotFoundError, match="export again"):
        find_export(confirmed.workspace, confirmed.collection.id + 1, made.name)


@pytest.mark.parametrize("wrong", ["", "../x", "x" * 50])
def test_an_id_that_is_none_is_not_found(confirmed, wrong) -> None:
    with pytest.raises(NotFoundError, match="export again"):
        find_export(confirmed.workspace, confirmed.collection.id, wrong)


def test_an_expired_export_is_gone_and_swept_by_the_next(confirmed, monkeypatch) -> None:
    monkeypatch.setattr(module, "EXPORT_TTL", timedelta(seconds=-1))
    old, _ = export(confirmed)
    with pytest.raises(NotFoundError, match="export again"):
        find_export(confirmed.workspace, confirmed.collection.id, old.name)
    export(confirmed)
    assert not any(old.name in key for key in confirmed.workspace.arrays.list("exports"))


def test_a_failure_leaves_nothing(filled) -> None:
    filled.preprocessed()
    with pytest.raises(NotFoundError):
        export(filled)
    assert filled.workspace.arrays.list("exports") == []
