"""train, evaluate, refine: what they say and how they end. The work itself is the workers'."""

from pathlib import Path

import pytest

from partwise.errors import NotEnoughDataError, NotFoundError
from partwise.store.records import NewModel
from partwise.workspace.choices import ScoreName
from partwise.workspace.progress import RunProgress
from partwise_workers import passes, training
from partwise_workers.stages import evaluate


def test_train_says_which_model_came_of_it(invoke, described: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def train(workspace, collection, on_progress):
        on_progress(5, 5)
        return workspace.catalog.save_model(NewModel(collection.id, {"train_s": 12.3}, "models/x.safetensors", ()))

    monkeypatch.setattr(training, "train_collection", train)
    result = invoke("train", described)
    assert (result.exit_code, result.stderr) == (0, "train: 5 of 5\n")
    assert result.stdout == "model version 1, trained on 0 shapes in 12 s\n"


def test_train_needs_labels(invoke, described: Path) -> None:
    result = invoke("train", described)
    assert isinstance(result.exception, NotEnoughDataError)
    assert "'mugs'" in str(result.exception)


@pytest.mark.parametrize("command", ["evaluate", "refine"])
def test_a_pass_needs_a_model(invoke, described: Path, command: str) -> None:
    result = invoke(command, described)
    assert isinstance(result.exception, NotFoundError)
    assert "run `partwise train`" in str(result.exception)


@pytest.mark.parametrize(
    ("progress", "lines", "code"),
    [
        (RunProgress(3, 0, 3), "3 shapes {}, 0 failed\n", 0),
        (RunProgress(1, 1, 2), "1 shape {}, 1 failed\n`partwise status` says why\n", 1),
        (RunProgress(0, 0, 0), "nothing to do: every shape that is ready for it has been {}\n", 0),
    ],
)
@pytest.mark.parametrize(("command", "done"), [("evaluate", "evaluated"), ("refine", "refined")])
def test_a_pass_says_how_it_went(
    invoke,
    refined: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: str,
    done: str,
    progress: RunProgress,
    lines: str,
    code: int,
) -> None:
    monkeypatch.setattr(passes, command, lambda *_: progress)
    result = invoke(command, refined)
    assert (result.stdout, result.exit_code) == (lines.format(done), code)


def test_the_scores_on_offer_are_those_that_evaluation_gives() -> None:
    assert set(evaluate.SCORES) == set(ScoreName)
