"""Figures of a collection for graphs."""

from datetime import UTC, datetime, timedelta

import pytest

from partwise.testing.workspaces import save_model
from partwise.workspace.figures import collection_figures, stored_bytes


def _figures(filled, after_s: float = 0.0):
    return collection_figures(filled.workspace, filled.collection, datetime.now(UTC) + timedelta(seconds=after_s))


def test_before_anything_is_described_nothing_waits(filled) -> None:
    figures = _figures(filled)
    assert (figures.n_free, figures.n_held, figures.oldest_s) == (0, 0, 0.0)
    assert (figures.fresh_share, figures.model_version, figures.mean_score, figures.agreement) == (None,) * 4


def test_what_waits_and_what_is_held_is_counted(filled) -> None:
    filled.described()
    catalog = filled.workspace.catalog
    catalog.claim_shape(filled.ids["a.off"], catalog.add_person("ann").id, 60)
    figures = _figures(filled, after_s=90)
    assert (figures.n_free, figures.n_held) == (2, 1)
    assert figures.oldest_s == pytest.approx(90, abs=30)


def test_the_newest_model_and_how_much_it_has_scored(filled) -> None:
    filled.described()
    first = filled.evaluated()
    assert (_figures(filled).model_version, _figures(filled).fresh_share) == (first.version, 1.0)
    mean = sum(s.value for s in filled.workspace.catalog.scores(filled.ids.values(), "entropy").values()) / 3
    assert _figures(filled).mean_score == pytest.approx(mean)
    second = save_model(filled.workspace, filled.collection)
    assert (_figures(filled).model_version, _figures(filled).fresh_share) == (second.version, 0.0)


def test_what_is_stored_grows_with_the_blocks(filled) -> None:
    before = stored_bytes(filled.workspace)
    assert before > 0
    filled.described()
    assert stored_bytes(filled.workspace) > before
