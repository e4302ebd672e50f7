"""A collection's settings: defaults where the row is silent, ranges, changes."""

from dataclasses import replace

import pytest

from partwise.errors import ParameterError
from partwise.store.queue_settings import queue_settings_of
from partwise.store.records import JobKind
from partwise.testing.expect import raises
from partwise.workspace.settings import CollectionSettings, change_settings, settings_of


def test_a_collection_that_says_nothing_has_the_defaults(collection) -> None:
    assert settings_of(replace(collection, settings={})) == CollectionSettings(
        up="y", working_faces=10_000, remesh="auto", labels_per_shape=1, train_after=5
    )


def test_keys_of_other_versions_are_left_alone(workspace, collection) -> None:
    odd = workspace.catalog.update_collection_settings(collection.id, {"upright": True, "up": "z"})
    changed = change_settings(workspace, odd, {"working_faces": 20_000})
    assert settings_of(changed) == CollectionSettings(up="z", working_faces=20_000)
    assert changed.settings == {"upright": True, "up": "z", "working_faces": 20_000}


def test_a_change_is_there_for_the_next_reader(workspace, collection) -> None:
    change_settings(workspace, collection, {"remesh": "never"})
    assert settings_of(workspace.catalog.get_collection(collection.name)).remesh == "never"


def test_settings_of_the_queue_are_settings_of_the_collection(workspace, collection) -> None:
    changed = change_settings(workspace, collection, {"honeypot_share": 0.05, "review": True})
    assert (settings_of(changed).honeypot_share, settings_of(changed).review) == (0.05, True)
    assert queue_settings_of(changed.settings).honeypot_share == 0.05


@pytest.mark.parametrize(("labels_per_shape", "kinds"), [(2, [JobKind.REFILL]), (1, [])])
def test_the_queue_follows_the_number_of_labels(workspace, collection, labels_per_shape, kinds) -> None:
    change_settings(workspace, collection, {"labels_per_shape": labels_per_shape})
    assert [job.kind for job in workspace.catalog.jobs(collection.id)] == kinds


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"up": "w"}, ("up must be one of x, y, z but is 'w'",)),
        ({"remesh": "always"}, ("remesh must be one of auto, never but is 'always'",)),
        ({"agreement": 1.5}, ("agreement must be a share in [0, 1] but is 1.5",)),
        ({"labels_per_shape": 0}, ("labels_per_shape must be a whole number 1 to 9 but is 0",)),
        ({"working_faces": 99}, ("faces of working meshes must be 100 to 1,000,000 but are 99;",)),
        ({"working_faces": 1_000_001}, ("faces of working meshes must be 100 to 1,000,000 but are 1,000,001",)),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_changed(workspace, collection, changes, words) -> None:
    with raises(ParameterError, *words):
        change_settings(workspace, collection, changes)
    assert workspace.catalog.get_collection(collection.name) == collection
