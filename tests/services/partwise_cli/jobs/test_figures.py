"""Figures are told while a worker works or waits, and never end it."""

import threading

import pytest

from partwise.errors import StoreError
from partwise.workspace.figures import CollectionFigures
from partwise_cli.jobs import figures
from partwise_cli.jobs.cluster import Cluster
from partwise_workers import metrics


@pytest.fixture
def told(monkeypatch):
    """What was told of collections, in place of Ray's metrics."""
    found: dict[str, CollectionFigures] = {}

    class Metrics:
        def tell(self, collection: str, of_it: CollectionFigures) -> None:
            found[collection] = of_it

        def tell_stored(self, n_bytes: int) -> None:
            assert n_bytes > 0

    monkeypatch.setattr(metrics, "CollectionMetrics", Metrics)
    return found


class _Connected(Cluster):
    @property
    def is_connected(self) -> bool:
        return True


def test_every_collection_is_told(workspace, told) -> None:
    figures.Figures(workspace, Cluster()).tell()
    assert list(told) == ["mugs"]
    assert told["mugs"].n_free == 3


def test_they_are_told_again_and_again_once_ray_is_there(workspace, told) -> None:
    with figures.Figures(workspace, _Connected(), every_s=0.01):
        for _ in range(2):
            told.clear()
            while not told:
                threading.Event().wait(0.005)


def test_a_catalog_that_cannot_be_reached_is_tried_again(workspace, told, monkeypatch, caplog) -> None:
    answers = iter([StoreError("gone")])

    def sometimes(*_: object) -> CollectionFigures:
        for error in answers:
            raise error
        return CollectionFigures(0, 0, 0.0, None, None, None, None, None)

    monkeypatch.setattr(figures, "collection_figures", sometimes)
    with figures.Figures(workspace, _Connected(), every_s=0.01):
        while not told:
            threading.Event().wait(0.005)
    assert "gone" in caplog.text


def test_without_ray_nothing_is_told(workspace, told, monkeypatch) -> None:
    asked = threading.Event()

    class NotConnected(Cluster):
        @property
        def is_connected(self) -> bool:
            asked.set()
            return False

    with figures.Figures(workspace, NotConnected(), every_s=0.001):
        assert asked.wait(30)
    assert told == {}
