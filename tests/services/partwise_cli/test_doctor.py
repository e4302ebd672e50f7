"""doctor: what a machine has and lacks."""

import json
import sys
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest

from partwise.errors import StoreError
from partwise_cli.commands import doctor as module
from partwise_cli.commands.doctor import Finding


@pytest.fixture
def healthy(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine on which what takes long to find out is fine."""
    monkeypatch.setattr(module, "_ray", lambda: Finding("Ray", True, "local, 2 cores"))
    monkeypatch.setattr(module, "_renderer", lambda: Finding("depth views", True, "ray casting"))


@pytest.mark.usefixtures("healthy")
def test_a_machine_that_has_everything_is_fine(invoke) -> None:
    result = invoke("doctor")
    assert result.exit_code == 0
    assert "wrong" not in result.stdout
    assert "local, 2 cores" in result.stdout


@pytest.mark.usefixtures("healthy")
def test_findings_as_json(invoke, described: Path) -> None:
    findings = {each["what"]: each for each in json.loads(invoke("doctor", described, "--json").stdout)}
    assert {"numpy", "torch", "ray", "free disk", "training on", "stores"} <= set(findings)
    assert findings["stores"]["found"] == "1 collection, arrays can be written"
    assert all(each["is_fine"] for each in findings.values())


@pytest.mark.usefixtures("healthy")
def test_a_missing_package_has_a_remedy(invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    def version(package: str) -> str:
        if package == "numba":
            raise PackageNotFoundError(package)
        return "1.0"

    monkeypatch.setattr(module, "version", version)
    result = invoke("doctor", "--json")
    assert result.exit_code == 1
    (wrong,) = [each for each in json.loads(result.stdout) if not each["is_fine"]]
    assert (wrong["what"], wrong["remedy"]) == ("numba", "pip install 'partwise[workers]'")


@pytest.mark.parametrize(
    ("package", "find"),
    [("torch", "_graphics_card"), ("partwise_workers.cluster", "_ray"), ("partwise.render.probe", "_renderer")],
)
def test_what_cannot_be_loaded_is_a_finding(monkeypatch: pytest.MonkeyPatch, package: str, find: str) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    finding = getattr(module, find)()
    assert not finding.is_fine
    assert finding.remedy == "pip install 'partwise[workers]'"


def test_a_cluster_out_of_reach_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    def connected() -> None:
        raise StoreError("the Ray cluster must be reachable but is not")

    monkeypatch.setattr("partwise_workers.cluster.connected", connected)
    assert module._ray() == Finding(
        "Ray", False, "the Ray cluster must be reachable but is not", "start the cluster, or unset RAY_ADDRESS"
    )


def test_too_little_disk_is_a_finding(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(module, "MIN_FREE_GB", 10**9)
    finding = module._disk(tmp_path / "not" / "made" / "yet")
    assert not finding.is_fine
    assert str(tmp_path) in finding.found
    assert "array_url" in finding.remedy


def test_stores_that_cannot_be_opened_are_a_finding(tmp_path: Path) -> None:
    finding = module._stores(tmp_path)
    assert not finding.is_fine
    assert "partwise init" in finding.found
