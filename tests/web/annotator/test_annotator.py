"""The way of an annotator, from the address that `partwise up` shows to a model that has learnt from them."""

import re
import shutil
from datetime import datetime
from itertools import islice
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import expect

from partwise.labels.annotation_cost import annotation_cost
from partwise.labels.stroke_json import stroke_from_document
from partwise.workspace.workspace import open_workspace

START = 1
"""Strokes of a draft before its person does anything: the labels that it starts from."""
TRAINING_MS = 240_000
FIRST_CUT_MS = 120_000
"""Where nothing ran before, the kernels that cut are compiled first."""
OTHER_COLOURS = 20
"""Of 255, on average: more than smoother edges make of it."""


@pytest.fixture(scope="module")
def service(finished_chairs, tmp_path_factory, serve):
    """One service for all tests of this module: each has people of its own, and gives back what they held."""
    workspace = shutil.copytree(finished_chairs, tmp_path_factory.mktemp("served") / "workspace")
    with serve(workspace) as started:
        yield started


@pytest.fixture
def bench(log_in, request):
    """An annotator of this test's own, with the next shape of the queue in hand."""
    opened = log_in(f"who tests {request.node.name}")
    opened.open()
    return opened


def kinds(strokes) -> list[str]:
    return [stroke["kind"] for stroke in strokes]


def ranking(bench) -> list[tuple[str, float, int]]:
    """Shapes in the order of their scores, as the service has it."""
    shapes = bench.get("/collections/1/shapes?order=entropy&direction=desc")["items"]
    return [(shape["source_key"], shape["score"], shape["model_version"]) for shape in shapes]


def tiles(table) -> list[str]:
    return [
        tile.split(",")[0] for tile in table.get_by_role("gridcell").evaluate_all("all => all.map(e => e.ariaLabel)")
    ]


def start_from(bench, choice: str) -> None:
    bench.page.get_by_role("button", name="Start from").click()
    bench.page.get_by_role("menuitem", name=choice).click()


def two_places(bench) -> list[tuple[float, float]]:
    """On the shape, on different parts."""
    return [place for _, place in islice(bench.places(), 2)]


def label_by_patches(bench, first, second) -> None:
    """From nothing: a click at one place, a drag from the other. The rest stays grey."""
    with bench.page.expect_response("**/patches", timeout=FIRST_CUT_MS):
        start_from(bench, "Patches")
    expect(bench.page.get_by_text("Cutting…")).to_be_hidden()
    bench.page.keyboard.press("1")
    bench.click_at(*first)
    bench.page.keyboard.press("2")
    bench.drag(second, (second[0] + 0.02, second[1]))
    shown = bench.shown()
    assert shown["seat"] > 0
    assert shown["back"] > 0
    assert shown["leg"] == shown["arm"] == 0 < shown["Unlabelled"]


def refine_boundaries(bench) -> None:
    bench.page.keyboard.press("r")
    expect(bench.page.get_by_role("button", name="Boundaries again")).to_be_enabled()
    assert bench.shown()["Unlabelled"] == 0  # boundary refinement fills what is grey


@pytest.mark.timeout(600)
def test_from_logging_in_to_another_model(chairs, serve, browse, bench_in) -> None:
    with open_workspace(chairs) as workspace:
        workspace.catalog.update_collection_settings(1, {"train_after": 1})
    with serve(chairs, "up") as up:
        table = browse().new_page()
        table.goto(up.login_url)
        expect(table.get_by_role("link", name="Workbench")).to_be_visible()
        table.goto(f"{up.origin}/c/1/table?order=entropy&dir=desc")
        bench = bench_in(table.context.new_page(), up.origin)
        bench.open()
        name, lease, draft = bench.shape_name, bench.lease(), bench.draft()
        scores = ranking(bench)
        tile = table.get_by_role("gridcell", name=name)
        expect(tile).to_have_attribute("data-state", "ready")
        assert tiles(table) == [shape for shape, _, _ in scores]

        first, second = two_places(bench)
        label_by_patches(bench, first, second)
        refine_boundaries(bench)
        bench.page.keyboard.press("b")
        bench.page.keyboard.press("4")
        bench.click_at(*first)
        painted = bench.shown()
        bench.page.get_by_role("button", name="Undo").click()
        assert bench.shown()["arm"] < painted["arm"]
        bench.page.keyboard.press("Control+Shift+z")
        assert bench.shown() == painted
        strokes = bench.expect_recorded(draft["id"], START + 7)
        assert kinds(strokes[START:]) == ["clear", "assign", "assign", "delta", "paint", "undo", "redo"]

        bench.page.keyboard.press("Enter")  # though Undo was clicked last
        expect(bench.page.get_by_text(f"{name} is confirmed.")).to_be_attached()
        bench.wait_saved()
        assert bench.shape_name != name
        revision = bench.get(f"/shapes/{lease['shape_id']}/revisions")["items"][0]
        assert revision["sha256"] == bench.get(f"/drafts/{draft['id']}")["labels_sha256"]

        expect(tile).to_have_attribute("data-state", "confirmed")  # without a reload
        expect(table.get_by_role("status", name="Training")).to_contain_text("Training", timeout=TRAINING_MS)
        next_model = lease["model_version"] + 1
        expect(tile).to_contain_text(f"m{next_model}", timeout=TRAINING_MS)
        held = {each["source_key"] for each in bench.get("/leases")["items"]}  # which keep the score of their lease
        bench.until(
            lambda: {model for shape, _, model in ranking(bench) if shape not in held} == {next_model},
            TRAINING_MS / 1000,
        )
        assert ranking(bench) != scores
        table.get_by_role("button", name="Show", exact=True).click()  # nothing moves before it is asked for
        bench.until(lambda: tiles(table) == [shape for shape, _, _ in ranking(bench)])
        table.context.close()  # before the service ends, which it would log


def test_every_tool_by_keyboard(bench) -> None:
    """Turned so that the seat is in the middle, where keys press."""
    press = bench.page.keyboard.press
    draft_id = bench.draft()["id"]
    start_from(bench, "Nothing")
    bench.view.focus()
    press("Shift+t")
    press("1")
    press("b")
    press("]")
    press("Space")
    with bench.page.expect_response("**/patches", timeout=FIRST_CUT_MS):
        press("p")
    expect(bench.page.get_by_text("Cutting…")).to_be_hidden()
    press("3")
    press("Space")
    press("r")
    expect(bench.page.get_by_role("button", name="Boundaries again")).to_be_enabled()
    with bench.page.expect_response("**/refine-model"):
        press("m")
    bench.until(lambda: len(bench.strokes(draft_id)) == START + 5)
    press("w")
    press("2")
    press("Space")
    press("i")
    press("Space")
    expect(bench.page.get_by_role("radio", name="back")).to_be_checked()
    expect(bench.page.get_by_role("button", name="Paint")).to_have_attribute("aria-pressed", "true")
    press("e")
    press("Space")
    press("Control+z")
    press("Control+y")
    strokes = bench.expect_recorded(draft_id, START + 9)
    assert kinds(strokes[START:]) == [
        "clear", "paint", "assign", "delta", "delta", "segment_wide", "paint", "undo", "redo"
    ]  # fmt: skip
    assert [stroke["source"] for stroke in strokes if stroke["kind"] == "delta"] == [
        "start_from", "boundary_refinement", "model_refinement"
    ]  # fmt: skip


@pytest.mark.parametrize(("choice", "segmentation"), [("Predicted labels", "predicted"), ("Refined labels", "refined")])
def test_a_shape_starts_from_what_the_model_says(bench, choice, segmentation) -> None:
    draft, lease = bench.draft(), bench.lease()
    start_from(bench, "Nothing")
    start_from(bench, choice)
    strokes = bench.expect_recorded(draft["id"], START + 2)
    assert strokes[-1]["parameters"] == {"from": segmentation}
    assert bench.labels_of(lease["shape_id"], segmentation).tolist() == bench.labels(draft["id"]).tolist()


def test_a_shape_is_skipped_with_a_reason(bench) -> None:
    name, lease = bench.shape_name, bench.lease()
    bench.page.keyboard.press("s")
    dialog = bench.page.get_by_role("dialog", name=f"Skip {name}")
    dialog.get_by_role("radio", name="None of the parts fit").check()
    dialog.get_by_label("Note").fill("It is a stool")
    dialog.get_by_role("button", name="Skip this shape").click()
    expect(dialog).to_be_hidden()
    bench.wait_saved()
    assert bench.shape_name != name
    assert lease["id"] not in {held["id"] for held in bench.get("/leases")["items"]}


def test_the_sheet_of_keys_tells_what_keys_do(bench) -> None:
    bench.page.keyboard.press("?")
    sheet = bench.page.get_by_role("dialog", name="Keys of the workbench")
    expect(sheet.get_by_text("Confirm and next")).to_be_visible()
    bench.page.keyboard.press("Escape")
    expect(sheet).to_be_hidden()


def test_several_views_of_one_shape_and_of_several(bench) -> None:
    views = bench.page.get_by_role("region", name="View")
    bench.page.keyboard.press("v")
    expect(views).to_have_count(2)
    bench.page.keyboard.press("l")
    expect(bench.page.get_by_role("button", name="Link cameras")).to_have_attribute("aria-pressed", "true")

    bench.page.get_by_role("button", name="A shape in each view").click()
    expect(bench.page.get_by_text("Room for another shape")).to_be_visible()
    bench.page.get_by_role("button", name="Take the next of the queue").click()
    expect(bench.page.get_by_text("Room for another shape")).to_be_hidden()

    def in_hand() -> list[dict[str, Any]]:
        return [lease for lease in bench.get("/leases")["items"] if not lease["is_prefetched"]]

    bench.until(lambda: len(in_hand()) == 2)
    for lease in in_hand():
        expect(bench.page.get_by_role("region", name=lease["source_key"])).to_be_visible()


def test_a_view_shows_other_labels_and_how_unsure_the_model_is_beside_the_draft(bench) -> None:
    draft_id, page = bench.draft()["id"], bench.page
    page.keyboard.press("v")
    second = page.get_by_role("region", name="View 2 of 2")
    page.get_by_role("button", name="View 2 of 2 shows: Draft").click()
    with page.expect_response("**/labels?segmentation=predicted"):
        page.get_by_role("menuitemradio", name="Predicted labels").click()
    shows = page.get_by_role("button", name="View 2 of 2 shows: Predicted")
    expect(shows).to_be_visible()
    second.focus()
    page.keyboard.press("Space")
    expect(page.get_by_text("This view is to look at.")).to_be_visible()
    second.click()
    assert len(bench.strokes(draft_id)) == START  # the draft is not drawn on through it

    page.get_by_role("button", name="View 2 of 2 shows: Predicted").click()
    page.get_by_role("menuitemradio", name="Confirmed labels").click()
    expect(page.get_by_text("Nobody has confirmed labels of this shape yet.")).to_be_visible()
    second.focus()
    drafted = bench.middle_of(second)
    with page.expect_response("**/uncertainty"):
        page.keyboard.press("u")
    expect(page.get_by_text("unsure", exact=False).first).to_be_visible()
    bench.until(lambda: np.abs(bench.middle_of(second) - drafted).mean() > OTHER_COLOURS)
    page.keyboard.press("u")
    expect(page.get_by_role("button", name="View 2 of 2 shows: Draft")).to_be_visible()


def test_letters_are_keys_again_after_a_choice_from_a_list(bench) -> None:
    page = bench.page
    only_over = page.get_by_label("Only over")
    only_over.click()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(only_over).not_to_have_value("any")
    page.keyboard.press("h")
    expect(page.get_by_role("button", name="Turn", exact=True)).to_have_attribute("aria-pressed", "true")


def test_the_edges_of_faces_are_shown_on_demand(bench) -> None:
    bench.page.keyboard.press("t")
    edges = bench.page.get_by_role("button", name="Edges of faces")
    expect(edges).to_have_attribute("aria-pressed", "true")
    with_edges = bench.view.screenshot()
    edges.click()
    bench.until(lambda: bench.view.screenshot() != with_edges)


def test_time_and_clicks_are_shown_as_they_will_be_on_record(bench) -> None:
    draft = bench.draft()
    place = two_places(bench)[0]
    for part in ("e", "2"):
        bench.page.keyboard.press(part)
        bench.click_at(*place)
    strokes = [stroke_from_document(each) for each in bench.expect_recorded(draft["id"], START + 2)]
    cost = annotation_cost(strokes, opened_at=datetime.fromisoformat(draft["created_at"]))
    minutes, seconds = divmod(int(cost.active_s), 60)
    expect(bench.page.get_by_text(f"{minutes}:{seconds:02} at work · {cost.clicks} clicks")).to_be_visible()


def test_a_shape_that_an_operator_takes_away_is_told_before_the_next_heartbeat(log_in) -> None:
    bench = log_in("whose shape is taken", expects_errors=True)  # Chromium logs that it is not renewed
    bench.open()
    draft_id, lease = bench.draft()["id"], bench.lease()
    place = two_places(bench)[0]
    bench.page.keyboard.press("e")
    bench.click_at(*place)
    bench.wait_saved()
    operator = log_in("who takes shapes away", "operator")
    assert operator.post(f"/leases/{lease['id']}/clear")["outcome"] == "cleared"

    expect(bench.page.get_by_text("An operator took this shape back")).to_be_visible()
    expect(bench.page.get_by_text("Nothing is lost")).to_be_visible()
    assert lease["shape_id"] not in {
        each["shape_id"] for each in bench.get("/leases")["items"]
    }  # it does not take it back
    bench.expect_recorded(draft_id, START + 1)

    bench.page.get_by_role("button", name="Ask for it again").click()
    expect(bench.page.get_by_text("An operator took this shape back")).to_be_hidden()
    bench.page.keyboard.press("Control+z")
    assert kinds(bench.expect_recorded(draft_id, START + 2)[START:]) == ["paint", "undo"]


def test_a_shape_that_somebody_else_has_is_refused_by_its_name(bench, log_in) -> None:
    lease = bench.lease()
    other = log_in("who wants the same", expects_errors=True)
    other.page.goto(f"{bench.origin}/c/1/work?shapes={lease['shape_id']}")
    expect(other.page.get_by_text(f"{lease['source_key']} is with someone else now")).to_be_visible()


def test_a_shape_that_nothing_reads_says_so_and_is_shown_once_asked_again(log_in) -> None:
    bench = log_in("whose network drops a file", expects_errors=True)
    reader = re.compile(r"/mesh\.worker-[^/]*\.js$")
    bench.page.route(reader, lambda route: route.abort())
    bench.page.goto(f"{bench.origin}/c/1/work")
    expect(bench.page.get_by_text("what reads it could not be loaded")).to_be_visible()
    bench.page.unroute(reader)
    bench.page.get_by_role("button", name="Try again").click()
    bench.wait_saved()


def test_nobody_confirms_a_shape_that_cannot_be_shown(log_in) -> None:
    bench = log_in("whose browser shows no shapes")
    bench.page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    bench.open()
    lease = bench.lease()
    expect(bench.page.get_by_text("Shapes cannot be shown")).to_be_visible()
    expect(bench.page.get_by_role("button", name="Confirm and next")).to_be_disabled()
    bench.page.keyboard.press("Enter")
    bench.page.keyboard.press("s")  # keys are heard
    expect(bench.page.get_by_role("dialog", name=f"Skip {lease['source_key']}")).to_be_visible()
    assert lease["id"] in {held["id"] for held in bench.get("/leases")["items"]}


def test_a_reload_returns_to_the_same_shape_and_stroke(bench) -> None:
    name, draft_id = bench.shape_name, bench.draft()["id"]
    place = two_places(bench)[0]
    bench.page.keyboard.press("e")
    bench.click_at(*place)
    bench.page.keyboard.press("Control+z")
    before = bench.shown()
    bench.page.reload()
    strokes = bench.expect_recorded(draft_id, START + 2)
    assert kinds(strokes[START:]) == ["paint", "undo"]
    assert bench.shape_name == name
    assert bench.shown() == before
    bench.page.keyboard.press("Control+Shift+z")  # undo and redo outlive it
    assert kinds(bench.expect_recorded(draft_id, START + 3))[-1] == "redo"


def test_an_empty_queue_says_so_and_when_there_is_something_again(bench, log_in) -> None:
    others = [log_in(f"one of many {n}") for n in range(2)]
    taken = [
        other.post("/queue/claim", collection_id=1, shape_ids=some)
        for other, some in zip(others, halves(bench), strict=True)
    ]
    held = bench.get("/leases")["items"]
    bench.page.goto(f"{bench.origin}/c/1/table")
    for lease in held:
        bench.post(f"/leases/{lease['id']}/skip", reason="nothing fits")
    bench.page.goto(f"{bench.origin}/c/1/work")
    expect(bench.page.get_by_text("Nothing waits for you")).to_be_visible()
    assert others[0].post(f"/leases/{taken[0]['items'][0]['id']}/release")
    expect(bench.page.get_by_text("The queue has changed")).to_be_visible()
    bench.page.get_by_role("button", name="Take the next shape").click()
    bench.wait_saved()


def halves(bench) -> tuple[list[int], list[int]]:
    """Shapes that wait and are not this person's, in two parts, since nobody holds more than four."""
    own = {lease["shape_id"] for lease in bench.get("/leases")["items"]}
    rest = [shape["id"] for shape in bench.get("/collections/1/shapes?state=ready")["items"] if shape["id"] not in own]
    return rest[::2], rest[1::2]
