"""The page: the build's files with the right types and caching, its places, and nothing outside of it."""

import gzip
from pathlib import Path

import pytest

from partwise_service.settings import ServiceSettings

INDEX = "<!doctype html><title>built</title>"
SCRIPT = "export const answer = 42\n"
HASHED = "/assets/index-B3f9.js"
OTHER = "/assets%2f..%2f..%2foutside.txt"
LINKS = ("/.secret", "/link.txt", "/%00", f"/{'x' * 5000}")


@pytest.fixture
def build(tmp_path: Path) -> Path:
    folder = tmp_path / "static"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text(INDEX)
    (folder / "assets" / "index-B3f9.js").write_text(SCRIPT)
    (folder / "assets" / "index-B3f9.js.br").write_bytes(b"as if it were brotli")
    (folder / "assets" / "index-B3f9.js.gz").write_bytes(gzip.compress(SCRIPT.encode()))
    (folder / "assets" / "plain-1.css").write_text("a{}")
    (folder / "assets" / "odd-1.exe").write_text("<script>alert(1)</script>")
    (folder / ".secret").write_text("hidden")
    (tmp_path / "outside.txt").write_text("outside")
    (folder / "link.txt").symlink_to(tmp_path / "outside.txt")
    return folder


class TestBuilt:
    @pytest.fixture
    def settings(self, mugs, build) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, page_folder=build)

    @pytest.mark.parametrize("path", ["/", "/index.html", "/collections/1/table", "/workbench", "/apiary"])
    def test_places_within_the_page_are_the_page(self, client, path) -> None:
        answer = client.get(path)
        assert (answer.status_code, answer.text) == (200, INDEX)
        assert answer.headers["content-type"] == "text/html; charset=utf-8"
        assert answer.headers["cache-control"] == "no-cache"

    def test_what_has_a_hash_in_its_name_may_be_kept(self, client) -> None:
        answer = client.get("/assets/plain-1.css")
        assert (answer.text, answer.headers["content-type"]) == ("a{}", "text/css; charset=utf-8")
        assert answer.headers["cache-control"] == "public, max-age=31536000, immutable"

    @pytest.mark.parametrize(
        ("accepted", "coding"), [("br, gzip", "br"), ("gzip", "gzip"), ("br;q=0, gzip", "gzip"), ("identity", None)]
    )
    def test_the_builds_own_copies_go_to_who_takes_them(self, client, accepted, coding) -> None:
        with client.stream("GET", HASHED, headers={"Accept-Encoding": accepted}) as answer:
            raw = b"".join(answer.iter_raw())
        assert answer.headers.get("content-encoding") == coding
        assert answer.headers["vary"] == "Accept-Encoding"
        assert answer.headers["content-type"] == "text/javascript; charset=utf-8"
        expected = {"br": b"as if it were brotli", "gzip": gzip.compress(SCRIPT.encode()), None: SCRIPT.encode()}
        assert len(raw) == len(expected[coding])

    def test_who_holds_a_file_is_told_so(self, client) -> None:
        tag = client.get("/").headers["etag"]
        answer = client.get("/", headers={"If-None-Match": tag})
        assert (answer.status_code, answer.content) == (304, b"")

    @pytest.mark.parametrize("path", ["/", HASHED])
    def test_head_has_the_headers_only(self, client, path) -> None:
        answer = client.head(path, headers={"Accept-Encoding": "identity"})
        assert (answer.status_code, answer.content) == (200, b"")
        assert int(answer.headers["content-length"]) == len(client.get(path).content)

    def test_an_asset_of_an_older_build_is_missing(self, client) -> None:
        answer = client.get("/assets/index-0000.js")
        assert (answer.status_code, answer.headers["content-type"]) == (404, "application/problem+json")

    @pytest.mark.parametrize(
        "path",
        ["/../outside.txt", "/%2e%2e/outside.txt", "/assets/..%2f..%2foutside.txt", "/..%5coutside.txt", OTHER, *LINKS],
    )
    def test_nothing_outside_the_build_is_served(self, client, path) -> None:
        answer = client.get(path)
        assert answer.text == INDEX or answer.status_code == 404
        assert "outside" not in answer.text.replace(path, "")
        assert "hidden" not in answer.text

    def test_types_are_chosen_by_the_service(self, client) -> None:
        answer = client.get("/assets/odd-1.exe")
        assert answer.headers["content-type"] == "application/octet-stream"
        assert answer.headers["x-content-type-options"] == "nosniff"

    @pytest.mark.parametrize("path", ["/api", "/api/", "/api/v2/me", "/api/v1/nothing"])
    def test_the_api_is_not_the_page(self, client, path) -> None:
        assert client.get(path).status_code == 404

    def test_a_method_that_the_api_lacks_is_still_refused(self, client) -> None:
        assert client.get("/api/v1/login").status_code == 405

    def test_the_page_takes_no_other_methods(self, client) -> None:
        answer = client.post("/", content=b"x")
        assert (answer.status_code, answer.headers["allow"]) == (405, "GET, HEAD")

    def test_scripts_and_styles_come_from_files_of_the_service_only(self, client) -> None:
        policy = dict(each.split(" ", 1) for each in client.get("/").headers["content-security-policy"].split("; "))
        assert (policy["script-src"], policy["style-src"]) == ("'self'", "'self'")
        assert (policy["img-src"], policy["worker-src"]) == ("'self' blob: data:", "'self' blob:")


class TestNotBuilt:
    @pytest.fixture
    def settings(self, mugs, tmp_path) -> ServiceSettings:
        return ServiceSettings(workspace=mugs.path, page_folder=tmp_path / "static")

    def test_the_page_says_how_to_build_it(self, client) -> None:
        answer = client.get("/")
        assert (answer.status_code, answer.headers["content-type"]) == (200, "text/html; charset=utf-8")
        assert "make web" in answer.text
        assert str(Path.cwd()) not in answer.text

    def test_it_appears_once_it_is_built(self, client, build) -> None:
        assert client.get("/").text == INDEX
