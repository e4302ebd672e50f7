"""What an operator does: sees what failed and why, tries it again, stops jobs, frees shapes, gives tokens, exports."""

import re
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from playwright.sync_api import Page, expect

from partwise.config import CONFIG_FILE
from partwise.workspace.workspace import INITIAL_CONFIG, init_collection

Enter = Callable[..., Page]
Recorded = Callable[[Page, str], Any]
COLLECTION = "/collections/1"
JOB_MS = 180_000
"""For a worker to start and to do a job, on a machine that has much else to do."""
FEW_ATTEMPTS = """
[remesh]
levels = [1000]
min_wrap_faces = 500

[[remesh.wraps]]
alpha_percent = 3.0
offset_percent = 1.0

[[remesh.contours]]
n_cells = 32
"""


@pytest.fixture
def two_balls(tmp_path: Path) -> Path:
    """A file of two balls far from each other: half of it is lost with whichever piece is left out."""
    ball = trimesh.creation.icosphere(subdivisions=2)
    vertices = np.concatenate([ball.vertices, ball.vertices + 4.0])
    faces = np.concatenate([ball.faces, ball.faces + len(ball.vertices)])
    path = tmp_path / "two balls.off"
    path.write_text(trimesh.Trimesh(vertices, faces, process=False).export(file_type="off"))
    return path


@pytest.fixture
def empty_up(tmp_path: Path, serve: Callable[..., Any]) -> Iterator[Any]:
    """`partwise up` of a collection without shapes, which makes few attempts at mending one."""
    path = tmp_path / "empty"
    path.mkdir()
    (path / CONFIG_FILE).write_text(INITIAL_CONFIG + FEW_ATTEMPTS)
    init_collection(path, "things", ["body"], {})
    with serve(path, "up") as started:
        yield started


def _jobs(page: Page) -> Any:
    return page.get_by_role("region", name="Jobs").first.get_by_role("row")


def test_a_shape_that_cannot_be_mended_is_shown_with_its_reason_and_tried_again(
    empty_up, browse, two_balls: Path
) -> None:
    page = browse().new_page()
    page.goto(empty_up.login_url)
    page.get_by_role("link", name="Settings").click()
    page.get_by_role("link", name="Add files").click()
    page.get_by_label("Files to add").set_input_files(two_balls)
    expect(page.get_by_text("1 of 1 sent")).to_be_visible()

    page.get_by_role("link", name="Operations").click()
    row = page.get_by_role("row", name=re.compile("two balls.off.*Refused"))
    expect(row).to_be_visible(timeout=JOB_MS)
    expect(row).to_contain_text("Remesh")
    expect(row).to_contain_text("attempts were refused")
    expect(_jobs(page).filter(has_text="Add files")).to_contain_text("Done")
    [failure] = page.request.get(f"{empty_up.origin}/api/v1{COLLECTION}/failures").json()["items"]
    assert (failure["stage"], failure["kind"]) == ("remesh", "error")

    row.get_by_role("button", name=re.compile("^Details")).click()
    dialog = page.get_by_role("dialog", name="two balls.off")
    expect(dialog).to_contain_text("Remesh gave up after 1 try")
    dialog.get_by_role("button", name="Try again").click()
    expect(page.get_by_text("1 shape will be tried again as soon as a worker is free.")).to_be_visible()
    again = _jobs(page).filter(has_text="Prepare shapes").first
    expect(again).to_contain_text("Done", timeout=JOB_MS)
    expect(row).to_be_visible()  # it fails as before


def test_labels_are_exported_and_downloaded(chairs: Path, serve, browse, tmp_path: Path) -> None:
    with serve(chairs, "up") as service:
        page = browse(accept_downloads=True).new_page()
        page.goto(service.login_url)
        page.get_by_role("link", name="Settings").click()
        page.get_by_role("link", name="Export").click()
        page.get_by_role("button", name="Export").click()
        link = page.get_by_role("link", name=re.compile("^Download: Export"))
        expect(link).to_be_visible(timeout=JOB_MS)
        with page.expect_download() as started:
            link.click()
        started.value.save_as(tmp_path / "labels.zip")
        page.close()  # before the service ends
    with zipfile.ZipFile(tmp_path / "labels.zip") as archive:
        names = [name for name in archive.namelist() if name.endswith(".seg")]
        assert len(names) == 2
        assert {int(line) for line in archive.read(names[0]).split()} <= {1, 2, 3, 4, 5, 6}


def test_a_job_that_waits_is_cancelled_and_asked_for_again(enter: Enter, recorded: Recorded) -> None:
    page = enter("olaf", "operator", "operations")
    page.get_by_role("button", name="Start a job").click()
    page.get_by_role("menuitem", name="Score shapes").click()
    expect(page.get_by_text("If it stays so, start a worker")).to_be_visible()
    row = _jobs(page).filter(has_text="Score shapes")
    expect(row).to_contain_text("Waits")
    row.get_by_role("button", name=re.compile("^Cancel")).click()
    expect(row).to_contain_text("Cancelled")
    row.get_by_role("button", name=re.compile("^Try again")).click()
    expect(row.first).to_contain_text("Waits")
    jobs = recorded(page, f"{COLLECTION}/jobs")["items"]
    assert next(job["state"] for job in jobs if job["kind"] == "evaluate") == "pending"


def test_a_worker_is_there_with_what_it_takes(empty_up, browse) -> None:
    page = browse().new_page()
    page.goto(empty_up.login_url)
    page.get_by_role("link", name="Operations").click()
    row = page.get_by_role("region", name="Workers").get_by_role("row").filter(has_text="Waits for a job")
    expect(row).to_contain_text(re.compile(r"\d+(\.\d)? MB"))  # its memory
    expect(row).to_contain_text(re.compile(r"\d+(\.\d)? [GT]B"))  # its disk


def test_a_shape_that_somebody_holds_is_taken_away(enter: Enter, recorded: Recorded) -> None:
    annotator = enter("ann", "annotator", "work", expects_errors=True)  # 409, once the shape is no longer hers
    expect(annotator.get_by_role("button", name="Confirm and next")).to_be_enabled()
    held = annotator.get_by_label("Shape in hand").get_by_role("heading", level=2).inner_text()

    page = enter("olaf", "operator", "operations")
    row = page.get_by_role("region", name="In hands").get_by_role("row").filter(has_text=held)
    expect(row).to_contain_text("ann")
    row.get_by_role("button", name=f"Take {held} away").click()
    page.get_by_role("alertdialog").get_by_role("button", name="Take away").click()
    expect(page.get_by_text(f"{held} is free again.")).to_be_visible()
    expect(row).to_have_count(0)
    assert held not in [lease["source_key"] for lease in recorded(page, f"{COLLECTION}/leases")["items"]]

    [shape_id] = [each["id"] for each in recorded(page, f"{COLLECTION}/shapes")["items"] if each["source_key"] == held]
    other = enter("ben", "annotator", f"work?shapes={shape_id}")
    expect(other.get_by_role("button", name="Confirm and next")).to_be_enabled()
    expect(other.get_by_label("Shape in hand").get_by_role("heading", level=2)).to_have_text(held)


def test_a_token_is_shown_once_lets_in_and_is_revoked(service, browse) -> None:
    page = browse().new_page()
    page.goto(service.login_url)
    page.get_by_role("link", name="Settings").click()
    page.get_by_role("link", name="People and tokens").click()
    page.get_by_role("button", name="New token for ada").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Role").select_option("reviewer")
    dialog.get_by_label("Note").fill("for the tablet")
    dialog.get_by_role("button", name="Make token").click()
    secret = dialog.locator("code").inner_text()
    page.get_by_role("dialog").get_by_role("button", name="Done").click()
    assert secret not in page.content()

    other = browse(expects_errors=True).new_page()
    other.goto(service.origin)
    other.get_by_label("Token or login link").fill(secret)
    other.get_by_role("button", name="Log in").click()
    expect(other.get_by_role("link", name="Workbench")).to_be_visible()

    row = page.get_by_role("row").filter(has_text="for the tablet")
    expect(row).to_contain_text("Reviewer")
    row.get_by_role("button", name=re.compile("^Revoke")).click()
    page.get_by_role("alertdialog").get_by_role("button", name="Revoke").click()
    expect(page.get_by_text("The token of ada is revoked.")).to_be_visible()
    expect(row).to_have_count(0)
    other.reload()
    expect(other.get_by_role("button", name="Log in")).to_be_visible()
