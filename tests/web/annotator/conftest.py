"""An annotator's browser: what they see and do in the workbench, and what the service has on record of it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from itertools import product
from time import monotonic
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import BrowserContext, Locator, Page, Position, expect
from safetensors.numpy import load

COLLECTION = 1
PATIENCE_S = 30
_STEPS = [0.14 + 0.09 * step for step in range(9)]
_FROM_THE_MIDDLE = sorted(product(_STEPS, repeat=2), key=lambda at: (at[0] - 0.5) ** 2 + (at[1] - 0.5) ** 2)
"""Places of a view as shares of its width and height, the middle first."""


def _pixels_of(view: Locator) -> np.ndarray:
    """(height, width, 3) what a view shows, 0 to 255."""
    return np.asarray(Image.open(BytesIO(view.screenshot())).convert("RGB"), dtype=np.int64)


@dataclass(frozen=True)
class Bench:
    """The workbench in one tab: what its person sees of the shape in hand, and what the service has on record of it."""

    page: Page
    origin: str

    @property
    def view(self) -> Locator:
        return self.page.get_by_role("region", name="Shape", exact=True)

    @property
    def save_state(self) -> Locator:
        return self.page.get_by_role("status", name="Save state")

    @property
    def shape_name(self) -> str:
        return self.page.get_by_label("Shape in hand").get_by_role("heading", level=2).inner_text()

    def until(self, look: Callable[[], Any], patience_s: float = PATIENCE_S) -> Any:
        """What `look` returns once it is true of anything; the page goes on meanwhile."""
        deadline = monotonic() + patience_s
        while not (found := look()):
            assert monotonic() < deadline, "what is waited for does not come"
            self.page.wait_for_timeout(50)
        return found

    def wait_saved(self) -> None:
        expect(self.save_state).to_have_text("Saved")

    def in_another_tab(self) -> "Bench":
        """The same browser's next tab, with nothing in it."""
        return Bench(self.page.context.new_page(), self.origin)

    def click_at(self, across: float, down: float) -> None:
        """Clicks the view at a share of its width and height."""
        self.view.click(position=self._position(across, down))

    def drag(self, *places: tuple[float, float], releases: bool = True) -> None:
        """Presses at the first place and moves over the others."""
        box = self.view.bounding_box()
        assert box is not None
        points = [(box["x"] + at["x"], box["y"] + at["y"]) for at in (self._position(*place) for place in places)]
        mouse = self.page.mouse
        mouse.move(*points[0])
        mouse.down()
        for point in points[1:]:
            mouse.move(*point, steps=8)
        if releases:
            mouse.up()

    def places(self) -> Iterator[tuple[str, tuple[float, float]]]:
        """The parts that the view shows, each with a place where it is: what the tool that picks parts finds."""
        parts = self.page.get_by_role("group", name="Parts")
        paint = self.page.get_by_role("button", name="Paint", exact=True)
        found: set[str] = set()
        for place in _FROM_THE_MIDDLE:
            self.page.keyboard.press("i")
            self.click_at(*place)
            if paint.get_attribute("aria-pressed") != "true":
                continue  # beside the shape: the tool is still in hand
            part = parts.locator("label:has(:checked)").evaluate("row => row.title.split('\\n')[0]")
            if part not in found:
                found.add(part)
                yield part, place

    def surface_share(self) -> float:
        """How much of the view the shape covers, from 0 to 1: what is not as grey as the stage."""
        pixels = _pixels_of(self.view)
        return float((np.abs(pixels - pixels[2, 2]).sum(axis=2) > 24).mean())

    @staticmethod
    def middle_of(view: Locator) -> np.ndarray:
        """(height, width, 3) what a view shows, without what stands in its corners."""
        pixels = _pixels_of(view)
        height, width, _ = pixels.shape
        return pixels[height // 4 : -height // 4, width // 4 : -width // 4]

    def _position(self, across: float, down: float) -> Position:
        box = self.view.bounding_box()
        assert box is not None
        return {"x": across * box["width"], "y": down * box["height"]}

    def shown(self) -> dict[str, int]:
        """Faces of each part, as the list of parts tells them."""
        titles = (
            self.page.get_by_role("group", name="Parts").locator("label").evaluate_all("all => all.map(e => e.title)")
        )
        rows = [title.split("\n") for title in titles]
        return {row[0]: int(row[-1].split()[0].replace(",", "")) for row in rows}

    def get(self, path: str) -> Any:
        answer = self.page.context.request.get(f"{self.origin}/api/v1{path}")
        assert answer.ok, answer.text()
        return answer.json()

    def post(self, path: str, **body: Any) -> Any:
        """What the service answers, or None if it refuses."""
        address = f"{self.origin}/api/v1{path}"
        headers = {"Origin": self.origin}  # as a page's own requests have it
        answer = self.page.context.request.post(address, data=body or None, headers=headers)
        return answer.json() if answer.ok else None

    def lease(self) -> dict[str, Any]:
        name = self.shape_name
        return next(lease for lease in self.get("/leases")["items"] if lease["source_key"] == name)

    def draft(self) -> dict[str, Any]:
        """The person's draft of the shape in hand."""
        return dict(self.get(f"/shapes/{self.lease()['shape_id']}/draft"))

    def strokes(self, draft_id: int) -> list[dict[str, Any]]:
        return list(self.get(f"/drafts/{draft_id}/strokes")["items"])

    def labels(self, draft_id: int) -> np.ndarray:
        """(m,) labels that the strokes on record leave."""
        return self._labels_at(f"/drafts/{draft_id}/labels")

    def labels_of(self, shape_id: int, segmentation: str) -> np.ndarray:
        """(m,) labels of a shape on record."""
        return self._labels_at(f"/shapes/{shape_id}/labels?segmentation={segmentation}")

    def _labels_at(self, path: str) -> np.ndarray:
        answer = self.page.context.request.get(f"{self.origin}/api/v1{path}")
        assert answer.ok, answer.text()
        return load(answer.body())["labels"]

    def open(self, *shape_ids: int) -> None:
        """Goes to the workbench, for shapes by name or the next of the queue."""
        asked = f"?shapes={','.join(map(str, shape_ids))}" if shape_ids else ""
        self.page.goto(f"{self.origin}/c/{COLLECTION}/work{asked}")
        self.wait_saved()

    def expect_recorded(self, draft_id: int, n_strokes: int) -> list[dict[str, Any]]:
        """So many strokes are on record, each once and in order, and leave the labels that are shown; the strokes."""
        self.until(lambda: len(self.strokes(draft_id)) >= n_strokes)
        self.wait_saved()
        strokes = self.strokes(draft_id)
        assert [stroke["sequence"] for stroke in strokes] == list(range(n_strokes))
        assert len({stroke["id"] for stroke in strokes}) == n_strokes
        labels = self.labels(draft_id)
        counts = np.bincount(labels, minlength=len(self.shown()))
        expected = [*counts[1:].tolist(), int(counts[0])]
        self.until(lambda: list(self.shown().values()) == expected)
        return [stroke["payload"] for stroke in strokes]


@pytest.fixture(scope="session")
def bench_in() -> type[Bench]:
    """`Bench`, for tests that log in by themselves."""
    return Bench


@pytest.fixture
def log_in(
    service: Any, browse: Callable[..., BrowserContext], token_of: Callable[[str, str], str]
) -> Iterator[Callable[..., Bench]]:
    """Gives a person a browser, logged in. What they hold is given back afterwards, for the next test."""
    benches: list[Bench] = []

    def bench_of(person: str, role: str = "annotator", **options: Any) -> Bench:
        context = browse(**options)
        answer = context.request.post(f"{service.origin}/api/v1/login", data={"token": token_of(person, role)})
        assert answer.ok, answer.text()
        benches.append(Bench(context.new_page(), service.origin))
        return benches[-1]

    yield bench_of
    for bench in benches:
        for lease in bench.get("/leases")["items"]:
            bench.post(f"/leases/{lease['id']}/release")
