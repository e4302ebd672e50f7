"""Everybody can work here: by keys alone, with a screen reader, on a small screen, in either scheme."""

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

Enter = Callable[..., Page]
AXE = Path(__file__).parents[2] / "services/web/node_modules/axe-core/axe.min.js"
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
PLACES = {
    "table": "table",
    "map": "table?panel=map",
    "parts": "table?panel=parts",
    "reviews": "table?panel=reviews",
    "workbench": "work?shapes=2",
    "operations": "operations",
    "labelling": "settings/labelling",
    "files": "settings/files",
    "export": "settings/export",
    "people": "settings/people",
    "audit": "settings/audit",
}
UNDER_WAY = re.compile("^(Reading|Loading|Opening)")
"""What a spinner says: it fades in, so that its contrast is low at first."""
SCREENS = ((1280, 720), (820, 1180))
OPERATED = {
    "button", "link", "textbox", "searchbox", "combobox", "listbox", "option", "checkbox", "radio", "switch", "slider",
    "spinbutton", "tab", "menuitem", "menuitemradio", "menuitemcheckbox", "grid", "gridcell", "image", "dialog",
}  # fmt: skip
"""Roles of what can be operated, or must be told in words."""
VIOLATIONS = """
async (options) => (await axe.run(document, options)).violations.flatMap(({ id, nodes }) =>
  nodes.map(({ target, failureSummary }) => `${id}: ${target.join(' ')}: ${failureSummary}`))
"""
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
# A control is seen to have the focus by an outline or a ring: its own, or of what stands for it on the screen.
FOCUS = """
() => {
  const focused = document.activeElement;
  if (focused === document.body) return null;
  const shown = [focused, focused.nextElementSibling, focused.parentElement, ...focused.querySelectorAll('*')];
  const isMarked = shown.some((each) => {
    if (!each) return false;
    const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(each);
    return (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 1) || boxShadow !== 'none';
  });
  return { isMarked, what: focused.outerHTML.slice(0, 160) };
}
"""


@pytest.fixture(scope="module")
def service(
    finished_chairs: Path, serve: Callable[..., Any], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Any]:
    """One for all tests of this module: they change little, each something else."""
    workspace = shutil.copytree(finished_chairs, tmp_path_factory.mktemp("looked-at") / "workspace")
    with serve(Path(workspace)) as started:
        yield started


def _settle(page: Page) -> None:
    """Everything that was asked for is there."""
    expect(page.get_by_role("heading", level=1)).to_be_attached()
    expect(page.locator("[aria-busy=true]")).to_have_count(0)
    expect(page.locator("main").get_by_role("status").filter(has_text=UNDER_WAY)).to_have_count(0)
    if "/table" in page.url:
        expect(page.get_by_role("gridcell", name="chair").first).to_be_visible()
    if "/work" in page.url:
        expect(page.get_by_role("button", name="Confirm and next")).to_be_enabled()


def _violations(page: Page, **options: Any) -> list[str]:
    page.evaluate(AXE.read_text())
    page.evaluate("document.getAnimations().forEach((each) => each instanceof CSSTransition && each.finish())")
    experimental = {"label-content-name-mismatch": {"enabled": False}}  # tiles are named by more than their words
    return list(page.evaluate(VIOLATIONS, {**options, "rules": experimental}))


def _nameless(page: Page) -> list[str]:
    tree = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")["nodes"]
    shown = [node for node in tree if not node["ignored"] and node["role"]["value"] in OPERATED]
    assert shown
    return [str(node) for node in shown if not node.get("name", {}).get("value", "").strip()]


@pytest.mark.parametrize("place", PLACES)
def test_a_place_is_accessible_in_both_schemes_and_fits_small_screens(enter: Enter, place: str) -> None:
    page = enter("root", "admin", PLACES[place])
    _settle(page)
    assert _violations(page, runOnly=RULES) == []
    assert _nameless(page) == []
    page.emulate_media(color_scheme="dark")
    assert _violations(page, runOnly=["color-contrast"]) == []
    for width, height in SCREENS:
        page.set_viewport_size({"width": width, "height": height})
        _settle(page)
        assert page.evaluate(OVERFLOW) <= 0


@pytest.mark.parametrize("place", ["table", "workbench", "operations", "people"])
def test_the_focus_is_seen_wherever_it_is(enter: Enter, place: str) -> None:
    page = enter("root", "admin", PLACES[place])
    _settle(page)
    seen: list[str] = []
    for _ in range(60):
        page.keyboard.press("Tab")
        focus = page.evaluate(FOCUS)
        if focus is None or focus["what"] in seen:
            break  # it has left the page, or begun anew
        assert focus["isMarked"], focus["what"]
        seen.append(focus["what"])
    assert len(seen) > 10


def test_a_shape_is_labelled_and_confirmed_by_keys_alone(enter: Enter, recorded: Callable[[Page, str], Any]) -> None:
    page = enter("ann", "annotator", "table?state=ready")
    _settle(page)
    for _ in range(40):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.getAttribute('role')") == "grid":
            break
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    name = page.locator("[role=gridcell][data-state]").nth(2).locator("p[title]").get_attribute("title")
    page.keyboard.press("Enter")
    heading = page.get_by_label("Shape in hand").get_by_role("heading", level=2)
    expect(heading).to_have_text(str(name))
    _settle(page)
    page.keyboard.press("b")
    page.keyboard.press("2")
    page.keyboard.press("]")
    expect(page.get_by_role("button", name="Undo")).to_be_enabled()  # to start from what the model made
    page.keyboard.press("Space")
    expect(page.get_by_role("status", name="Save state")).to_have_text("Saved")
    page.keyboard.press("Enter")
    expect(heading.filter(has_text=str(name))).to_have_count(0)
    [row] = [each for each in recorded(page, "/collections/1/shapes")["items"] if each["source_key"] == name]
    assert (row["state"], row["author_name"]) == ("confirmed", "ann")
