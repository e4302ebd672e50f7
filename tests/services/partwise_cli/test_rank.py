"""select and queue: what they say and how they end."""

import json
from pathlib import Path

import pytest

from partwise.errors import NotEnoughDataError
from partwise.workspace.workspace import open_workspace


def test_select_names_the_shapes(invoke, described: Path) -> None:
    result = invoke("select", described, "-k", "3", "-n", "1")
    assert result.exit_code == 0
    assert "Label these first" in result.stdout
    assert all(name in result.stdout for name in ("a.off", "b.off", "c.off"))


def test_select_as_json(invoke, described: Path) -> None:
    document = json.loads(invoke("select", described, "-k", "2", "-n", "1", "--json").stdout)
    assert [row["cluster"] for row in document] == [0, 1]
    assert {row["shape"] for row in document} < {"a.off", "b.off", "c.off"}


def test_select_needs_described_shapes(invoke, ingested: Path) -> None:
    result = invoke("select", ingested)
    assert isinstance(result.exception, NotEnoughDataError)
    assert "run `partwise preprocess`" in str(result.exception)


@pytest.mark.parametrize("option", [("-k", "0"), ("-n", "0"), ("--seed", "-1")])
def test_select_refuses_numbers_out_of_range(invoke, described: Path, option: tuple[str, str]) -> None:
    assert invoke("select", described, *option).exit_code == 2


def test_the_queue_ranks_the_least_certain_first(invoke, refined: Path) -> None:
    lines = invoke("queue", refined).stdout.splitlines()
    rows = [[cell.strip() for cell in line.strip("│").split("│")] for line in lines if line.startswith("│")]
    assert [row[:3] for row in rows] == [["1", "c.off", "ready"], ["2", "b.off", "ready"], ["3", "a.off", "ready"]]
    assert [row[4:] for row in rows] == [["body 100%", "1"]] * 3


def test_the_queue_has_as_many_rows_as_asked_for(invoke, refined: Path) -> None:
    assert [row["shape"] for row in json.loads(invoke("queue", refined, "-l", "1", "--json").stdout)] == ["c.off"]


@pytest.mark.parametrize("score", ["entropy", "entropy_by_area"])
def test_the_queue_as_json(invoke, refined: Path, score: str) -> None:
    first = json.loads(invoke("queue", refined, "--score", score, "--json").stdout)[0]
    assert (first["rank"], first["shape"], first["state"], first["model_version"]) == (1, "c.off", "ready", 1)
    assert 0 < first["score"] < 1
    assert first["parts"] == {"body": pytest.approx(1.0)}


def test_before_a_model_the_queue_is_the_selection(invoke, described: Path) -> None:
    invoke("select", described, "-k", "2", "-n", "1")
    result = invoke("queue", described)
    assert "Queue of mugs: the first shapes, as there is no model yet" in result.stdout
    assert [row["score"] for row in json.loads(invoke("queue", described, "--json").stdout)] == [None, None]


def test_an_empty_queue_says_what_to_do(invoke, described: Path) -> None:
    assert invoke("queue", described).stdout == (
        "nothing is queued yet: choose the first shapes with `partwise select`\n"
    )
    assert invoke("queue", described, "--json").stdout == "[]\n"


def test_a_queue_without_scores_says_what_to_do(invoke, described: Path) -> None:
    from partwise.testing.workspaces import save_model

    with open_workspace(described) as workspace:
        save_model(workspace, workspace.catalog.get_collection("mugs"))
    assert "`partwise evaluate`" in invoke("queue", described).stdout


def test_an_empty_state_is_named(invoke, refined: Path) -> None:
    assert invoke("queue", refined, "--state", "confirmed").stdout == "no shape in state 'confirmed' is queued\n"
