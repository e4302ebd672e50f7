"""Timing tools over HTTP: what is timed, and when it cannot be."""

from pathlib import Path

import pytest

from partwise.errors import NotEnoughDataError
from partwise.workspace.shapes import find_collection
from partwise.workspace.workspace import open_workspace
from partwise_cli.bench.service_tools import ToolTiming, medians, time_service_tools

TOOLS = ("patches, random walks", "patches, k-means", "refine model", "refine boundaries")


def timed(path: Path, n_shapes: int) -> list[ToolTiming]:
    with open_workspace(path) as workspace:
        return time_service_tools(workspace, find_collection(workspace, None), n_shapes, lambda *_: None)


def test_a_median_is_of_one_tool() -> None:
    timings = [
        ToolTiming(f"{n}.off", tool, 10 * n, ms, 2.0 * ms, 3.0 * ms)
        for place, tool in enumerate(TOOLS, start=1)
        for n, ms in ((1, 1.0 * place), (2, 4.0 * place), (3, 5.0 * place))
    ]
    found = medians(timings)
    assert [(each.tool, each.n_faces) for each in found] == [(tool, 20) for tool in TOOLS]
    assert [each.milliseconds for each in found] == [(4.0 * n, 8.0 * n, 12.0 * n) for n in range(1, 5)]


def test_shapes_must_have_been_evaluated(ingested: Path) -> None:
    with pytest.raises(NotEnoughDataError, match="partwise evaluate"):
        timed(ingested, 1)


@pytest.mark.slow
def test_every_tool_is_timed_on_a_served_workspace(refined: Path) -> None:
    made = timed(refined, 1)
    assert [each.tool for each in made] == list(TOOLS)
    assert all(ms > 0 for each in made for ms in each.milliseconds)
    with open_workspace(refined) as workspace:
        assert all(token.revoked_at is not None for token in workspace.catalog.tokens())
