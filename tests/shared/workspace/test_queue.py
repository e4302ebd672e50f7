"""The ranked queue: the first shapes before there is a model, the least certain ones after."""

import numpy as np
import pytest

from partwise.store.records import FirstShape, RevisionKind, ShapeState
from partwise.workspace import queue as module
from partwise.workspace.choices import ScoreName
from partwise.workspace.labelling import commit_labels
from partwise.workspace.queue import all_ranked, ranked_queue


def _names(rows) -> list[str]:
    return [row.shape.source_key for row in rows]


def _select(filled, *keys: str) -> None:
    firsts = [FirstShape(filled.ids[key], ordinal, 0) for ordinal, key in enumerate(keys)]
    filled.workspace.catalog.replace_first_shapes(filled.collection.id, firsts)


def _confirm(filled, key: str) -> None:
    labels = np.ones(filled.meshes[key].n_faces, dtype=np.uint16)
    commit_labels(filled.workspace, filled.collection, filled.shape(key), labels, RevisionKind.HUMAN, "ann")


def test_nothing_is_queued_at_first(filled) -> None:
    assert ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10) == []


def test_before_a_model_the_first_shapes_are_queued_in_order(filled) -> None:
    filled.described()
    _select(filled, "sub/c.off", "a.off")
    rows = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10)
    assert _names(rows) == ["sub/c.off", "a.off"]
    assert [(row.rank, row.state, row.score, row.model_version, row.parts) for row in rows] == [
        (1, ShapeState.READY, None, None, ()),
        (2, ShapeState.READY, None, None, ()),
    ]


def test_before_a_model_states_and_limit_count_too(filled) -> None:
    filled.described()
    _select(filled, "sub/c.off", "a.off", "b.off")
    _confirm(filled, "sub/c.off")
    rows = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 1, [ShapeState.READY])
    assert [(row.rank, row.shape.source_key) for row in rows] == [(1, "a.off")]


def test_after_a_model_the_least_certain_comes_first(filled) -> None:
    filled.described().evaluated()
    rows = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10)
    assert _names(rows) == ["sub/c.off", "b.off", "a.off"]
    assert [row.rank for row in rows] == [1, 2, 3]
    assert sorted((row.score for row in rows), reverse=True) == [row.score for row in rows]


@pytest.mark.parametrize("score", list(ScoreName))
def test_every_score_can_be_ranked_by(filled, score: ScoreName) -> None:
    filled.described().evaluated()
    assert len(ranked_queue(filled.workspace, filled.collection, score, 10)) == 3


def test_a_row_says_what_was_predicted_and_by_which_model(filled) -> None:
    model = filled.described().evaluated()
    row = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 1)[0]
    assert row.model_version == model.version
    assert row.parts == (("body", pytest.approx(1.0)),)


def test_a_part_that_was_removed_since_goes_by_its_number(filled) -> None:
    filled.described().evaluated()
    filled.workspace.catalog.remove_part(filled.collection.id, 1)
    row = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 1)[0]
    assert row.parts == (("part 1", pytest.approx(1.0)),)


def test_states_are_filtered_after_a_model(filled) -> None:
    filled.described().evaluated()
    _confirm(filled, "sub/c.off")
    ready = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10, [ShapeState.READY])
    assert _names(ready) == ["b.off", "a.off"]
    confirmed = ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10, [ShapeState.CONFIRMED])
    assert _names(confirmed) == ["sub/c.off"]


def test_once_there_is_a_model_the_selection_is_not_queued(filled) -> None:
    filled.described()
    _select(filled, "a.off")
    filled.evaluated()
    assert ranked_queue(filled.workspace, filled.collection, ScoreName.ENTROPY, 10, [ShapeState.FAILED]) == []


def test_all_ranked_goes_through_every_page(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.described().evaluated()
    monkeypatch.setattr(module, "PAGE", 2)
    assert _names(all_ranked(filled.workspace, filled.collection, ScoreName.ENTROPY)) == ["sub/c.off", "b.off", "a.off"]
