"""Prefixes: what the machine's operator lists, and nothing beside it."""

import pytest

from partwise.errors import ConfigError, NotFoundError, ParameterError
from partwise.workspace.ingest_prefixes import below_prefix, parse_prefixes


@pytest.fixture
def prefixes(tmp_path):
    (tmp_path / "scans" / "mugs").mkdir(parents=True)
    (tmp_path / "secret").mkdir()
    (tmp_path / "scans" / "out").symlink_to(tmp_path / "secret")
    (tmp_path / "scans" / "round").symlink_to(tmp_path / "scans" / "round")
    (tmp_path / "scans" / "within").symlink_to(tmp_path / "scans" / "mugs")
    return parse_prefixes(f"scans={tmp_path / 'scans'}")


def test_folders_have_names(tmp_path) -> None:
    found = parse_prefixes(" scans=/data/scans, cad = /mnt/cad ,")
    assert {name: str(folder) for name, folder in found.items()} == {"scans": "/data/scans", "cad": "/mnt/cad"}
    assert parse_prefixes("") == {}


@pytest.mark.parametrize("text", ["/data", "scans=", "scans=data", "=/data", "a b=/data", "s=/a,s=/b"])
def test_what_is_no_list_is_refused(text) -> None:
    with pytest.raises(ConfigError, match="PARTWISE_SERVICE_INGEST_PREFIXES"):
        parse_prefixes(text)


@pytest.mark.parametrize("path", ["", ".", "mugs", "./mugs/", "within"])
def test_paths_lead_below_the_prefix(prefixes, path) -> None:
    assert below_prefix(prefixes, "scans", path).is_dir()


@pytest.mark.parametrize(
    "path", ["/etc", "..", "../secret", "mugs/../../secret", "a\\b", "a\x00b", ".hidden", "x/.ssh"]
)
def test_paths_that_lead_elsewhere_are_refused(prefixes, path) -> None:
    with pytest.raises(ParameterError, match="below a prefix"):
        below_prefix(prefixes, "scans", path)


@pytest.mark.parametrize("path", ["out", "out/x", "round", "nothing"])
def test_links_out_of_it_are_not_found(prefixes, path) -> None:
    with pytest.raises(NotFoundError, match="nothing at"):
        below_prefix(prefixes, "scans", path)


def test_only_listed_prefixes_are_known(prefixes) -> None:
    with pytest.raises(NotFoundError, match="known: scans"):
        below_prefix(prefixes, "/etc", "passwd")
