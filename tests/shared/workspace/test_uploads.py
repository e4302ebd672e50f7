"""Uploads: bounded, found in their collection only, and gone when they expire."""

from datetime import timedelta

import pytest

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.workspace.uploads import (
    begin_upload,
    checked_upload_name,
    delete_upload,
    fetch_upload,
    find_upload,
    uploads,
)

DAY = timedelta(days=1)


def upload(workspace, collection, name="a.zip", data=b"bytes", ttl=DAY, max_open=3):
    writer = begin_upload(workspace, collection.id, name, "oscar", ttl, max_open)
    writer.write(data)
    return writer.finish()


def test_an_upload_is_fetched_as_it_was_sent(workspace, collection, tmp_path) -> None:
    made = upload(workspace, collection)
    path = fetch_upload(workspace, find_upload(workspace, collection.id, made.name), tmp_path)
    assert (path.name, path.read_bytes()) == ("a.zip", b"bytes")


def test_a_collection_has_so_many_at_most(workspace, collection) -> None:
    upload(workspace, collection)
    begin_upload(workspace, collection.id, "b.off", "oscar", DAY, 2)  # on its way
    with pytest.raises(ConflictError, match="may have 2 uploads"):
        begin_upload(workspace, collection.id, "c.off", "oscar", DAY, 2)
    assert len(workspace.arrays.list("uploads")) == 4  # a chunk, two marks and a description: nothing of the third


def test_what_was_abandoned_or_deleted_counts_no_more(workspace, collection) -> None:
    begin_upload(workspace, collection.id, "b.off", "oscar", DAY, 1).abandon()
    delete_upload(workspace, upload(workspace, collection, max_open=1))
    upload(workspace, collection, max_open=1)


def test_what_has_expired_is_gone(workspace, collection) -> None:
    made = upload(workspace, collection, ttl=timedelta(seconds=-1))
    assert uploads(workspace, collection.id) == []
    with pytest.raises(NotFoundError):
        find_upload(workspace, collection.id, made.name)
    upload(workspace, collection, max_open=1)
    assert [each.about["name"] for each in uploads(workspace, collection.id)] == ["a.zip"]


def test_those_on_their_way_are_not_listed(workspace, collection) -> None:
    begin_upload(workspace, collection.id, "b.off", "oscar", DAY, 1)
    assert uploads(workspace, collection.id) == []


def test_another_collections_upload_is_not_found(workspace, collection) -> None:
    made = upload(workspace, collection)
    with pytest.raises(NotFoundError):
        find_upload(workspace, collection.id + 1, made.name)


@pytest.mark.parametrize("wrong", ["", "..", "../1", "x/y", "20261122T120000Z-../../../catalog.sqlite", "a" * 5000])
def test_an_id_that_is_none_is_not_found(workspace, collection, wrong) -> None:
    with pytest.raises(NotFoundError):
        find_upload(workspace, collection.id, wrong)


@pytest.mark.parametrize("name", ["a.off", "A.OBJ", "many.zip", "many.tar.gz", "many.tgz", "a b.glb"])
def test_meshes_and_archives_are_taken(name) -> None:
    assert checked_upload_name(name) == name


@pytest.mark.parametrize(
    "name", ["", "x", "a.exe", "a.pkl", "../a.off", "x/a.off", "./a.off", ".a.off", "a\n.off", "C:a.off"]
)
def test_other_names_are_refused(name) -> None:
    with pytest.raises(ParameterError, match="upload's name"):
        checked_upload_name(name)
