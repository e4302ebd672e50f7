"""What a lead does: accepts many shapes, sends labels back, changes the parts, hands work out, decides what waits."""

import re
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page, expect

from partwise.store.records import JobState
from partwise.workspace.settings import change_settings
from partwise.workspace.workspace import open_workspace

Enter = Callable[..., Page]
Recorded = Callable[[Page, str], Any]
COLLECTION = "/collections/1"
NOTE = "The left armrest is labelled as seat."


def _grid(page: Page) -> Locator:
    return page.get_by_role("grid", name="Shapes")


def _tiles(page: Page) -> Locator:
    return _grid(page).locator("[role=gridcell][data-state]")


def _names(page: Page) -> list[str]:
    return _tiles(page).locator("p[title]").evaluate_all("all => all.map((name) => name.title)")


def _select_all(page: Page) -> Locator:
    """Selects everything in the list by the keyboard; the toolbar of what is selected."""
    expect(_tiles(page)).not_to_have_count(0)
    _grid(page).focus()
    page.keyboard.press("Control+a")
    return page.get_by_role("toolbar", name="Selected shapes")


def _in_hand(page: Page) -> str:
    """The name of the shape in hand, once it can be worked on."""
    expect(page.get_by_role("button", name="Confirm and next")).to_be_enabled()
    return page.get_by_label("Shape in hand").get_by_role("heading", level=2).inner_text()


def _confirm(page: Page) -> str:
    """Confirms the labels in hand; whose they were."""
    name = _in_hand(page)
    page.get_by_role("button", name="Confirm and next").click()
    expect(page.get_by_label("Shape in hand").get_by_role("heading", name=name)).to_have_count(0)
    return name


def _row(page: Page, recorded: Recorded, name: str) -> dict[str, Any]:
    rows = recorded(page, f"{COLLECTION}/shapes")["items"]
    return next(row for row in rows if row["source_key"] == name)


def test_many_shapes_are_accepted_and_blind_checks_tell_how_many_were_wrong(enter: Enter, recorded: Recorded) -> None:
    lead = enter("lena", "reviewer", "table?state=ready")
    bar = _select_all(lead)
    expect(bar).to_contain_text("6 selected")
    bar.get_by_role("button", name="Accept…").click()
    dialog = lead.get_by_role("dialog", name="Accept labels of 6 shapes")
    expect(dialog).to_contain_text("The refined labels, of model 1, become those of the shapes and are trained on.")
    expect(dialog).to_contain_text("labelled anew by people who are not told")
    dialog.get_by_label("Blind re-check").fill("2")
    dialog.get_by_role("button", name="Accept 4 shapes").click()
    expect(lead.get_by_text("4 shapes accepted, 2 others queued for a blind check")).to_be_visible()
    rows = recorded(lead, f"{COLLECTION}/shapes")["items"]
    assert sum(row["author_name"] == "lena" and row["state"] == "confirmed" for row in rows) == 4
    expect(_tiles(lead)).to_have_count(2)  # those that wait for the check
    _select_all(lead)
    expect(lead.get_by_text("All of these were acted on already.")).to_be_visible()

    annotator = enter("ann", "annotator", "work")
    _confirm(annotator)  # as the model has it
    _in_hand(annotator)
    annotator.get_by_role("button", name="Start from").click()
    annotator.get_by_role("menuitem", name="Nothing").click()
    annotator.keyboard.press("1")
    annotator.keyboard.press("w")
    annotator.get_by_role("region", name="Shape", exact=True).click()  # all of it is one part
    expect(annotator.get_by_role("status", name="Save state")).to_have_text("Saved")
    _confirm(annotator)

    lead.get_by_role("button", name="Reviews").click()
    lead.get_by_role("radio", name="Bulk accepts").check(force=True)
    panel = lead.get_by_role("complementary", name="Reviews")
    expect(panel).to_contain_text("50% wrong (95% interval 9.5% to 90.5%): 1 of 2 checked.")
    [batch] = recorded(lead, f"{COLLECTION}/accepts")["items"]
    assert (batch["n_accepted"], batch["n_rechecks"], batch["n_false"]) == (4, 2, 1)


def test_what_is_sent_back_is_first_in_its_authors_queue_with_the_note(
    enter: Enter, recorded: Recorded, service, browse
) -> None:
    lead = enter("lena", "reviewer", "table?state=confirmed")
    expect(_tiles(lead)).to_have_count(2)
    name = _names(lead)[1]
    _tiles(lead).nth(1).click()
    lead.get_by_role("button", name="Send back…").click()
    dialog = lead.get_by_role("dialog", name="Send back 1 shape")
    expect(dialog.get_by_role("button", name="Send back")).to_be_disabled()  # a note is due
    dialog.get_by_label("Note").fill(NOTE)
    dialog.get_by_role("checkbox", name="Only whoever labelled a shape gets it again").check()
    dialog.get_by_role("button", name="Send back").click()
    expect(lead.get_by_text("1 shape sent back")).to_be_visible()
    shape_id = _row(lead, recorded, name)["id"]
    [review] = [each for each in recorded(lead, f"/shapes/{shape_id}/reviews")["items"] if each["outcome"] is None]
    assert (review["reason"], review["detail"]["note"]) == ("rework", NOTE)

    author = browse().new_page()
    author.goto(service.login_url)
    author.get_by_role("link", name="Workbench").click()
    assert _in_hand(author) == name
    expect(author.get_by_text("These labels were sent back")).to_be_visible()
    expect(author.get_by_text(NOTE)).to_be_visible()


def test_parts_are_added_renamed_and_recoloured_and_the_workbench_has_them(enter: Enter, recorded: Recorded) -> None:
    lead = enter("lena", "reviewer", "table?panel=parts")
    panel = lead.get_by_role("complementary", name="Parts")
    before = recorded(lead, f"{COLLECTION}/parts")
    first = before["parts"][0]
    panel.get_by_role("button", name="Add a part").click()
    panel.get_by_label("Name").fill(first["name"])
    panel.get_by_role("button", name="Add", exact=True).click()
    expect(panel.get_by_role("alert")).to_be_visible()  # there is one of this name
    panel.get_by_label("Name").fill("wheel")
    panel.get_by_label("Explanation").fill("Turns on the ground.")
    panel.get_by_role("button", name="Add", exact=True).click()
    expect(panel.get_by_role("button", name="Change wheel")).to_be_visible()

    panel.get_by_role("button", name=f"Change {first['name']}").click()
    panel.get_by_label("Name").fill("throne")
    panel.get_by_label("Colour", exact=True).fill("#123456")
    panel.get_by_role("button", name="Save").click()
    expect(panel.get_by_role("button", name="Change throne")).to_be_visible()
    after = recorded(lead, f"{COLLECTION}/parts")
    assert after["version"] == before["version"] + 1
    assert after["parts"][0] | {"name": "throne", "colour": "#123456"} == after["parts"][0]
    assert (after["parts"][-1]["name"], after["parts"][-1]["gloss"]) == ("wheel", "Turns on the ground.")

    lead.get_by_role("link", name="Workbench").click()
    _in_hand(lead)
    parts = lead.get_by_role("group", name="Parts").locator("label")
    expect(parts.filter(has_text="throne").locator("span").first).to_have_css("background-color", "rgb(18, 52, 86)")
    expect(parts.filter(has_text="wheel")).to_have_attribute("title", re.compile("Turns on the ground"))


def test_shapes_are_assigned_to_somebody_whose_queue_they_are(enter: Enter, recorded: Recorded) -> None:
    annotator = enter("ann", "annotator", "table")
    operator = enter("olaf", "operator", "table?state=ready")
    expect(_tiles(operator)).to_have_count(6)
    name = _names(operator)[4]
    _tiles(operator).nth(4).click()
    operator.get_by_role("button", name="Assign…").click()
    dialog = operator.get_by_role("dialog", name="Assign 1 shape")
    expect(dialog.get_by_role("button", name="Assign")).to_be_disabled()  # nobody was chosen
    dialog.get_by_label("To").select_option("ann")
    dialog.get_by_role("button", name="Assign").click()
    expect(operator.get_by_text("1 waiting label is assigned")).to_be_visible()
    assert recorded(operator, f"{COLLECTION}/queue")["n_assigned"] == 1

    annotator.get_by_role("link", name="Workbench").click()
    assert _in_hand(annotator) == name


def test_labels_that_wait_for_a_look_are_accepted_or_sent_back(service, enter: Enter, recorded: Recorded) -> None:
    with open_workspace(service.workspace) as workspace:
        change_settings(workspace, workspace.catalog.get_collection("chairs"), {"review": True})
    annotator = enter("ann", "annotator", "work")
    first, second = _confirm(annotator), _confirm(annotator)

    lead = enter("lena", "reviewer", "table?panel=reviews")
    panel = lead.get_by_role("complementary", name="Reviews")
    expect(panel).to_contain_text("1 of 2")
    card = panel.get_by_role("article")
    expect(card).to_contain_text("By ann")
    expect(card).to_contain_text(re.compile(r"of work, \d+ clicks?"))
    accepted = card.get_by_role("heading").inner_text()
    card.get_by_role("button", name="Accept").click()
    expect(lead.get_by_text("Labels accepted")).to_be_visible()
    expect(panel).to_contain_text("1 of 1")
    rejected = card.get_by_role("heading").inner_text()
    assert {accepted, rejected} == {first, second}
    card.get_by_role("button", name="Send back").click()
    card.get_by_label("Note").fill(NOTE)
    card.get_by_role("button", name="Send back").click()
    expect(lead.get_by_text("Labels sent back")).to_be_visible()
    expect(panel).to_contain_text("Nothing waits for a look")
    assert _row(lead, recorded, accepted)["state"] == "confirmed"
    [waiting] = recorded(lead, f"{COLLECTION}/reviews")["items"]
    assert (waiting["shape_id"], waiting["reason"]) == (_row(lead, recorded, rejected)["id"], "rework")
    assert waiting["detail"]["note"] == NOTE


def test_whoever_comes_back_from_the_workbench_sees_what_they_did_there(enter: Enter) -> None:
    page = enter("lena", "reviewer", "table")
    ready = _tiles(page).and_(page.locator("[data-state=ready]")).first
    name = ready.locator("p[title]").get_attribute("title")
    ready.dblclick()
    assert _confirm(page) == name
    page.get_by_role("link", name="Table").click()
    expect(_tiles(page).filter(has=page.get_by_title(str(name)))).to_have_attribute("data-state", "confirmed")


def test_a_training_that_failed_says_why_to_whoever_asked_for_it(service, enter: Enter) -> None:
    lead = enter("lena", "reviewer", "table")
    line = lead.get_by_role("status", name="Model")
    line.get_by_role("button", name="Train now").click()
    expect(line).to_contain_text("Model 2 waits to be trained")
    with open_workspace(service.workspace) as workspace:
        job = workspace.catalog.claim_job("a worker")
        assert job is not None
        workspace.catalog.finish_job(job.id, "a worker", JobState.FAILED, message="the disk is full")
    expect(line).to_contain_text("Model 2 could not be trained: the disk is full")
    line.get_by_role("button", name="Try again").click()
    expect(line).to_contain_text("Model 2 waits to be trained")


def test_filters_and_order_are_in_the_address(enter: Enter, recorded: Recorded) -> None:
    page = enter("lena", "reviewer", "table")
    expect(_tiles(page)).to_have_count(8)
    page.get_by_role("button", name="Filter by state").click()
    page.get_by_role("menuitemradio", name="Ready").click()
    page.get_by_label("Order by").select_option("entropy")
    expect(page).to_have_url(re.compile(r"\?order=entropy&dir=desc&state=ready$"))
    expect(_tiles(page)).to_have_count(6)
    ranked = recorded(page, f"{COLLECTION}/shapes?order=entropy&direction=desc&state=ready")["items"]
    assert _names(page) == [row["source_key"] for row in ranked]

    page.get_by_role("button", name=re.compile("^Highest first")).click()
    expect(page).to_have_url(re.compile(r"\?order=entropy&state=ready$"))
    page.reload()
    expect(_tiles(page)).to_have_count(6)
    assert _names(page) == [row["source_key"] for row in reversed(ranked)]
    page.go_back()
    expect(page).to_have_url(re.compile("dir=desc"))
    page.get_by_role("button", name="Show any state").click()
    expect(_tiles(page)).to_have_count(8)


def test_names_are_searched_from_the_keyboard(enter: Enter, recorded: Recorded) -> None:
    page = enter("lena", "reviewer", "table")
    expect(_tiles(page)).to_have_count(8)
    name = _names(page)[3]
    part = name.removesuffix(".off").upper()
    page.keyboard.press("/")
    page.keyboard.type(part)
    box = page.get_by_role("textbox", name="Search names")
    expect(box).to_have_value(part)
    expect(page).to_have_url(re.compile(rf"\?name={part}$"))
    expect(_tiles(page)).to_have_count(1)
    assert _names(page) == [name]

    page.get_by_label("Order by").select_option("name")
    page.reload()
    expect(box).to_have_value(part)
    expect(_tiles(page)).to_have_count(1)
    box.press("Control+a")
    box.press_sequentially("no chair has this")
    expect(page.get_by_text("No name has “no chair has this” in it")).to_be_visible()
    box.press("Escape")
    expect(_tiles(page)).to_have_count(8)
    expect(page).to_have_url(re.compile(r"\?order=name$"))


def test_shapes_are_picked_on_the_map_and_put_first(enter: Enter, recorded: Recorded) -> None:
    page = enter("lena", "reviewer", "table?panel=map")
    canvas = page.get_by_role("application", name=re.compile("^Map of 8 shapes"))
    expect(canvas).to_be_visible()
    rectangle = page.get_by_role("radio", name="Rectangle")
    rectangle.click(force=True)
    expect(rectangle).to_be_checked()
    box = canvas.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 1, box["y"] + 1)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] - 1, box["y"] + box["height"] - 1, steps=6)
    page.mouse.up()
    bar = page.get_by_role("toolbar", name="Selected shapes")
    expect(bar).to_contain_text("8 selected")
    page.get_by_label("Of these 8, spread out").fill("2")
    page.get_by_role("complementary", name="Map").get_by_role("button", name="Put first in queue").click()
    expect(page.get_by_text("2 shapes put first in the queue")).to_be_visible()
    [entry] = [each for each in recorded(enter("root", "admin"), "/audit")["items"] if "first" in each["action"]]
    assert len(entry["detail"]["shape_ids"]) == 2
