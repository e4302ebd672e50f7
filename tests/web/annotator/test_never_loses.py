"""Whatever happens to the network, the service, a tab or a lease: each stroke is on record once, in order."""

import shutil
from datetime import UTC, datetime

import pytest
from playwright.sync_api import expect

SPOT = (0.5, 0.5)
"""On the seat of a chair that is seen from the top, as a share of the view."""
START = 1
"""Strokes of a draft before its person does anything: the labels that it starts from."""
LEASE_S = 6


@pytest.fixture(scope="module")
def service(finished_chairs, tmp_path_factory, serve):
    """One service for all tests of this module: each has people of its own, and gives back what they held."""
    workspace = shutil.copytree(finished_chairs, tmp_path_factory.mktemp("served") / "workspace")
    with serve(workspace, PARTWISE_SERVICE_LEASE_S=str(LEASE_S)) as started:
        yield started


def paint(bench, *parts: int) -> None:
    """Paints the same spot with one part after the other; 0 takes labels away."""
    bench.page.keyboard.press("Shift+t")
    for part in parts:
        bench.page.keyboard.press(str(part) if part else "e")
        bench.click_at(*SPOT)


def expect_painted(bench, draft_id: int, *parts: int) -> None:
    """Just these strokes are on record, and leave what is shown."""
    payloads = bench.expect_recorded(draft_id, START + len(parts))
    assert [payload["label"] for payload in payloads[START:]] == list(parts)


def waiting_shapes(bench) -> list[int]:
    return [shape["id"] for shape in bench.get("/collections/1/shapes?state=ready")["items"]]


@pytest.fixture
def opened(log_in):
    """A person with a shape in hand, in a browser of their own."""

    def open_for(person: str, shape_id: int | None = None, **options):
        bench = log_in(person, expects_errors=True, **options)  # Chromium logs requests that fail
        bench.open(shape_id or waiting_shapes(bench)[0])
        return bench

    return open_for


def test_strokes_wait_while_the_network_is_cut(opened) -> None:
    bench = opened("nora")
    draft_id = bench.draft()["id"]
    paint(bench, 0)
    bench.wait_saved()

    bench.page.context.set_offline(True)
    paint(bench, 1, 2, 3)
    expect(bench.save_state).to_have_text("Offline: 3 queued")
    expect(bench.page.get_by_role("status", name="Connection")).to_have_text("Offline")
    assert len(bench.strokes(draft_id)) == START + 1

    bench.page.context.set_offline(False)
    expect_painted(bench, draft_id, 0, 1, 2, 3)
    expect(bench.page.get_by_role("status", name="Connection")).to_have_text("Connected")


def test_a_closed_tab_has_sent_its_strokes_once_it_is_opened_again(opened) -> None:
    bench = opened("tess")
    draft_id, shape_id = bench.draft()["id"], bench.lease()["shape_id"]
    context = bench.page.context
    context.set_offline(True)
    paint(bench, 0, 2, 4)
    expect(bench.save_state).to_have_text("Offline: 3 queued")
    bench.page.close()

    context.set_offline(False)
    again = bench.in_another_tab()
    again.open(shape_id)
    expect_painted(again, draft_id, 0, 2, 4)


def test_strokes_of_a_shape_that_is_not_opened_again_are_sent_as_well(opened) -> None:
    bench = opened("lena")
    draft_id, lease_id = bench.draft()["id"], bench.lease()["id"]
    context = bench.page.context
    context.set_offline(True)
    paint(bench, 0, 1)
    expect(bench.save_state).to_have_text("Offline: 2 queued")
    bench.page.close()
    assert bench.post(f"/leases/{lease_id}/release")

    context.set_offline(False)
    again = bench.in_another_tab()
    again.open(waiting_shapes(bench)[-1])
    again.until(lambda: len(bench.strokes(draft_id)) == START + 2)


def test_the_service_killed_within_a_stroke(service, opened) -> None:
    bench = opened("kim")
    draft_id = bench.draft()["id"]
    paint(bench, 0)
    bench.wait_saved()

    bench.page.keyboard.press("2")
    bench.drag(SPOT, (SPOT[0] - 0.05, SPOT[1]), releases=False)
    service.kill()
    bench.page.mouse.up()
    paint(bench, 3)
    expect(bench.save_state).to_have_text("Offline: 2 queued")
    expect(bench.page.get_by_role("status", name="Connection")).to_have_text("Reconnecting")

    service.start()
    expect_painted(bench, draft_id, 0, 2, 3)


def test_an_answer_that_is_lost_after_the_commit(opened) -> None:
    bench = opened("otto")
    draft_id = bench.draft()["id"]
    sent: list[str] = []

    def lose_first(route) -> None:
        sent.append(route.request.post_data)
        if len(sent) > 1:
            return route.continue_()
        assert route.fetch().ok
        return route.abort()

    bench.page.route("**/strokes", lose_first)
    paint(bench, 0)
    bench.until(lambda: len(sent) > 1)
    assert sent[0] == sent[1]  # it is the id that tells that it is the same
    paint(bench, 2)
    expect_painted(bench, draft_id, 0, 2)


def test_a_lease_that_expired_while_nobody_else_came(opened) -> None:
    bench = opened("abel")
    draft_id, lease = bench.draft()["id"], bench.lease()
    bench.page.context.set_offline(True)
    paint(bench, 0, 1)
    bench.until(lambda: datetime.fromisoformat(bench.lease()["expires_at"]) < datetime.now(UTC))

    bench.page.context.set_offline(False)
    expect_painted(bench, draft_id, 0, 1)
    bench.page.keyboard.press("Enter")
    expect(bench.page.get_by_text(f"{lease['source_key']} is confirmed.")).to_be_attached()
    assert bench.get(f"/drafts/{draft_id}")["outcome"] == "confirmed"


def test_a_lease_that_somebody_else_has_meanwhile(opened, log_in) -> None:
    bench = opened("bea")
    draft_id, lease = bench.draft()["id"], bench.lease()
    bench.page.context.set_offline(True)
    paint(bench, 0, 1)
    other = log_in("carl")
    taken = other.until(lambda: other.post("/queue/claim", collection_id=1, shape_ids=[lease["shape_id"]]))

    bench.page.context.set_offline(False)
    expect(bench.page.get_by_text("This shape is not yours any more")).to_be_visible()
    expect_painted(bench, draft_id, 0, 1)

    assert other.post(f"/leases/{taken['items'][0]['id']}/release")
    expect(bench.page.get_by_text("This shape is not yours any more")).to_be_hidden()
    paint(bench, 2)
    expect_painted(bench, draft_id, 0, 1, 2)


def test_two_tabs_on_one_shape_one_edits_and_the_other_watches(opened) -> None:
    first = opened("tom")
    draft_id, shape_id = first.draft()["id"], first.lease()["shape_id"]
    second = first.in_another_tab()
    second.open(shape_id)
    watching = "You have this shape open in another tab"
    expect(second.page.get_by_text(watching)).to_be_visible()
    paint(first, 0, 1)
    expect_painted(second, draft_id, 0, 1)  # which shows there what is done here
    paint(second, 3)
    expect_painted(first, draft_id, 0, 1)  # who watches changes nothing

    second.page.get_by_role("button", name="Take over here").click()
    expect(first.page.get_by_text(watching)).to_be_visible()
    expect(second.page.get_by_text(watching)).to_be_hidden()
    paint(second, 2)
    expect_painted(first, draft_id, 0, 1, 2)

    second.page.close()
    expect(first.page.get_by_text(watching)).to_be_hidden()
    paint(first, 3)
    expect_painted(first, draft_id, 0, 1, 2, 3)


def test_a_tab_takes_over_what_the_other_could_not_send(opened) -> None:
    first = opened("una")
    draft_id, shape_id = first.draft()["id"], first.lease()["shape_id"]
    second = first.in_another_tab()
    second.open(shape_id)
    first.page.route("**/strokes", lambda route: route.abort())
    paint(first, 0, 1)
    expect(first.save_state).to_have_text("Offline: 2 queued")
    second.page.get_by_role("button", name="Take over here").click()
    paint(second, 2)
    expect_painted(second, draft_id, 0, 1, 2)


CONFLICT = "You worked on this shape in two places"


@pytest.fixture
def two_versions(opened, log_in):
    """A person who painted on in one browser while another of theirs was cut off: this other, and both strokes."""

    def make(person: str):
        away = opened(person)
        paint(away, 0)
        away.wait_saved()
        home = log_in(person, expects_errors=True)
        home.open(away.lease()["shape_id"])
        away.page.context.set_offline(True)
        paint(away, 1)
        paint(home, 2)
        home.wait_saved()
        away.page.context.set_offline(False)
        expect(away.page.get_by_text(CONFLICT)).to_be_visible()
        expect(away.save_state).to_have_text("Two versions")
        return away, home

    return make


def test_a_stale_save_is_refused_and_the_saved_version_taken(two_versions) -> None:
    away, home = two_versions("vera")
    draft_id = home.draft()["id"]
    expect_painted(home, draft_id, 0, 2)

    away.page.get_by_role("button", name="Take the saved one").click()
    expect_painted(away, draft_id, 0, 2)
    expect(away.page.get_by_text("1 stroke set aside")).to_be_visible()
    away.page.reload()
    away.page.get_by_role("button", name="Put on top").click()
    payloads = away.expect_recorded(draft_id, START + 3)
    assert payloads[-1]["label"] == 1  # what was set aside, as the faces that it had changed


def test_a_stale_save_is_refused_and_put_on_top(two_versions) -> None:
    away, home = two_versions("will")
    draft_id = home.draft()["id"]
    mine = away.shown()
    away.page.get_by_role("radio", name="Show the saved one").check()
    away.page.get_by_role("radio", name="Show mine").check()
    away.page.get_by_role("button", name="Put mine on top").click()
    payloads = away.expect_recorded(draft_id, START + 3)
    assert [payload["label"] for payload in payloads[START:]] == [0, 2, 1]
    assert away.shown() == mine  # the same spot
    away.page.keyboard.press("Enter")
    away.until(lambda: away.get(f"/drafts/{draft_id}")["outcome"] == "confirmed")
    expect(home.page.get_by_text("You confirmed this shape elsewhere")).to_be_visible()


def test_strokes_that_came_after_their_draft_was_closed_are_put_on_the_next_one(opened, log_in) -> None:
    away = opened("zoe")
    draft_id, lease = away.draft()["id"], away.lease()
    away.page.context.set_offline(True)
    paint(away, 0, 1)
    expect(away.save_state).to_have_text("Offline: 2 queued")
    home = log_in("zoe", expects_errors=True)  # 409, should the other window have renewed the lease first
    home.open(lease["shape_id"])
    home.page.keyboard.press("Enter")
    home.until(lambda: home.get(f"/drafts/{draft_id}")["outcome"] == "confirmed")

    away.page.context.set_offline(False)
    expect(away.page.get_by_text("You confirmed this shape elsewhere")).to_be_visible()
    away.page.get_by_role("button", name="Go to the next shape").click()
    expect(away.page.get_by_text("Strokes of other shapes are set aside")).to_be_visible()
    away.page.get_by_role("button", name=f"Open {lease['source_key']}").click()
    expect(away.page.get_by_text("2 strokes set aside")).to_be_visible()
    away.page.get_by_role("button", name="Put on top").click()
    expect(away.page.get_by_text("2 strokes set aside")).to_be_hidden()
    assert away.draft()["id"] != draft_id
    payloads = away.expect_recorded(away.draft()["id"], 2)
    assert [payload["label"] for payload in payloads] == [0, 1]


def test_labels_that_somebody_else_confirmed_meanwhile_are_looked_at_first(opened, log_in) -> None:
    bench = opened("xena")
    draft_id, lease = bench.draft()["id"], bench.lease()
    bench.page.context.set_offline(True)
    paint(bench, 0, 1)
    other = log_in("yan")
    other.until(lambda: other.post("/queue/claim", collection_id=1, shape_ids=[lease["shape_id"]]))
    other.open(lease["shape_id"])
    other.page.keyboard.press("Enter")
    expect(other.page.get_by_text(f"{lease['source_key']} is confirmed.")).to_be_attached()

    bench.page.context.set_offline(False)
    expect_painted(bench, draft_id, 0, 1)
    bench.page.keyboard.press("Enter")
    expect(bench.page.get_by_text("Somebody else confirmed this shape meanwhile")).to_be_visible()
    bench.page.get_by_role("radio", name="Show theirs").check()
    assert bench.get(f"/drafts/{draft_id}")["outcome"] is None

    bench.page.get_by_role("button", name="Confirm mine over theirs").click()
    expect(bench.page.get_by_text(f"{lease['source_key']} is confirmed.")).to_be_attached()
    assert bench.get(f"/drafts/{draft_id}")["outcome"] == "confirmed"
    revisions = bench.get(f"/shapes/{lease['shape_id']}/revisions")["items"]
    people = {someone.get("/me")["person_id"] for someone in (bench, other)}
    assert people <= {revision["author_id"] for revision in revisions}  # theirs are still there
