"""The page under fingers: one draws, two move and zoom, one that rests chooses."""

import shutil

import pytest
from playwright.sync_api import Locator, Page, expect

START = 1
"""Strokes of a draft before its person does anything: the labels that it starts from."""
WHITE = 250
"""Of 255: as the brush's ring is, and nothing else that a view shows."""
Points = list[tuple[float, float]]


@pytest.fixture(scope="module")
def service(finished_chairs, tmp_path_factory, serve):
    workspace = shutil.copytree(finished_chairs, tmp_path_factory.mktemp("touched") / "workspace")
    with serve(workspace) as started:
        yield started


class Fingers:
    """Fingers on an element, at shares of its width and height."""

    def __init__(self, page: Page, element: Locator) -> None:
        self._session = page.context.new_cdp_session(page)
        box = element.bounding_box()
        assert box is not None
        self._box = box

    def down(self, points: Points) -> None:
        self._send("touchStart", points)

    def move(self, points: Points) -> None:
        self._send("touchMove", points)

    def up(self) -> None:
        self._send("touchEnd", [])

    def _send(self, kind: str, points: Points) -> None:
        box = self._box
        places = [
            {"x": box["x"] + across * box["width"], "y": box["y"] + down * box["height"], "id": finger}
            for finger, (across, down) in enumerate(points)
        ]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})


@pytest.fixture
def bench(log_in, request):
    """The workbench on a tablet."""
    opened = log_in(f"who tests {request.node.name}", has_touch=True)
    opened.open()
    return opened


def test_one_finger_draws(bench) -> None:
    draft_id = bench.draft()["id"]
    _, (across, down) = next(bench.places())
    bench.page.keyboard.press("e")
    fingers = Fingers(bench.page, bench.view)
    fingers.down([(across, down)])
    for step in range(1, 6):
        fingers.move([(across, down + 0.04 * step)])
    fingers.up()
    strokes = bench.expect_recorded(draft_id, START + 1)
    assert strokes[-1]["kind"] == "paint"
    assert len(strokes[-1]["seeds"]) > 1


def test_two_fingers_zoom_and_draw_nothing(bench) -> None:
    draft_id = bench.draft()["id"]
    covered = bench.surface_share()
    fingers = Fingers(bench.page, bench.view)
    fingers.down([(0.45, 0.5)])
    fingers.down([(0.45, 0.5), (0.55, 0.5)])
    for step in range(1, 11):
        fingers.move([(0.45 - 0.02 * step, 0.5), (0.55 + 0.02 * step, 0.5)])
    fingers.up()
    bench.until(lambda: bench.surface_share() > 1.5 * covered)
    bench.wait_saved()
    assert len(bench.strokes(draft_id)) == START  # what the first finger began is given up


def test_a_finger_that_was_lifted_leaves_no_brush_behind(bench) -> None:
    _, (across, down) = next(bench.places())

    def is_brush_seen() -> bool:
        return bool((bench.middle_of(bench.view).min(axis=2) > WHITE).any())

    bench.page.mouse.move(1, 1)
    bench.until(lambda: not is_brush_seen())
    fingers = Fingers(bench.page, bench.view)
    fingers.down([(across, down)])
    for step in range(1, 4):
        fingers.move([(across, down - 0.02 * step)])
    bench.until(is_brush_seen)
    fingers.up()
    bench.until(lambda: not is_brush_seen())


def test_a_finger_that_rests_on_a_tile_chooses_it(bench) -> None:
    page = bench.page
    page.goto(f"{bench.origin}/c/1/table")
    tile = page.get_by_role("gridcell", name="chair").first
    expect(tile).to_be_visible()
    fingers = Fingers(page, tile)
    fingers.down([(0.5, 0.5)])
    expect(tile).to_have_attribute("aria-selected", "true")  # while it rests
    fingers.up()
    expect(page.get_by_text("1 selected")).to_be_visible()
    second = page.get_by_role("gridcell", name="chair").nth(1)
    second.tap()  # from then on a tap adds
    expect(page.get_by_text("2 selected")).to_be_visible()
