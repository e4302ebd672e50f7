"""Who comes in, and how they go."""

from playwright.sync_api import expect


def test_the_address_that_serve_shows_logs_one_in_once(service, browse) -> None:
    page = browse().new_page()
    page.goto(service.login_url)
    expect(page.get_by_role("link", name="Table")).to_be_visible()
    assert "code" not in page.url  # it is not left in the history

    stranger = browse(expects_errors=True).new_page()
    stranger.goto(service.login_url)
    expect(stranger.get_by_role("heading", name="Log in")).to_be_visible()
    expect(stranger.get_by_role("button", name="Log in")).to_be_enabled()


def test_a_token_logs_in_and_logging_out_forgets_it(service, token_of, browse) -> None:
    page = browse(expects_errors=True).new_page()  # who is not logged in is refused, which browsers log
    page.goto(service.origin)
    page.get_by_label("Token or login link").fill(token_of("ann", "annotator"))
    page.get_by_role("button", name="Log in").click()
    expect(page.get_by_role("link", name="Workbench")).to_be_visible()
    expect(page.get_by_role("link", name="Operations")).to_have_count(0)

    page.get_by_role("button", name="You and this page").click()
    page.get_by_role("menuitem", name="Log out").click()
    expect(page.get_by_role("button", name="Log in")).to_be_visible()
    page.reload()
    expect(page.get_by_role("button", name="Log in")).to_be_visible()


def test_a_wrong_token_is_explained(service, browse) -> None:
    page = browse(expects_errors=True).new_page()
    page.goto(service.origin)
    page.get_by_label("Token or login link").fill("pw_" + "x" * 43)
    page.get_by_role("button", name="Log in").click()
    expect(page.get_by_text("This token or link is not valid")).to_be_visible()
