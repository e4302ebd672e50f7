"""What deploy/ holds fits the project: images are not built here, but all that they name is looked up."""

import re
import shlex
from pathlib import Path

import pytest
import yaml
from typer.main import get_command

from partwise_cli.main import app
from partwise_service.settings import ServiceSettings

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"
SETTING = "PARTWISE_SERVICE_"


@pytest.fixture(scope="module")
def services() -> dict:
    return yaml.safe_load((DEPLOY / "compose.yaml").read_text(encoding="utf-8"))["services"]


def _our_commands(text: str) -> list[list[str]]:
    """Calls of `partwise` in a shell's text, without what follows them on the line."""
    calls = re.findall(r"\bpartwise (?!partwise)((?:[a-z]+ )+)/workspace([^#&\n\"`]*)", text)
    return [[*shlex.split(names), "/workspace", *shlex.split(rest)] for names, rest in calls]


def _refuse_unknown(arguments: list[str]) -> None:
    """Raises if the command line does not take these."""
    command = get_command(app)
    with command.make_context("partwise", arguments) as context:
        name, sub, rest = command.resolve_command(context, arguments)
        while hasattr(sub, "resolve_command"):
            name, sub, rest = sub.resolve_command(context, rest)
        sub.make_context(name, list(rest))


def test_commands_of_compose_are_taken(services: dict) -> None:
    calls = [shlex.join(each["command"]) for each in services.values() if "partwise" in str(each.get("command"))]
    found = [call for text in calls for call in _our_commands(text.replace("'", ""))]
    assert {call[0] for call in found} == {"serve", "work"}
    for call in found:
        _refuse_unknown(call)


def test_commands_of_the_page_are_taken() -> None:
    found = _our_commands((DEPLOY / "README.md").read_text(encoding="utf-8"))
    assert {call[0] for call in found} == {"init", "ingest", "token", "migrate", "status"}
    for call in found:
        _refuse_unknown(call)


def test_settings_in_compose_exist(services: dict) -> None:
    given = {name for each in services.values() for name in each.get("environment", {}) if name.startswith(SETTING)}
    assert given
    assert {name.removeprefix(SETTING).lower() for name in given} <= set(ServiceSettings.model_fields)


def test_the_page_says_how_to_set_each_secret() -> None:
    wanted = set(re.findall(r"\$\{(\w+):\?", (DEPLOY / "compose.yaml").read_text(encoding="utf-8")))
    [line] = re.findall(r"^for name in ([A-Z_ ]+);", (DEPLOY / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert set(line.split()) == wanted


def test_mounted_and_copied_files_exist(services: dict) -> None:
    mounted = [
        volume.split(":")[0] for each in services.values() for volume in each.get("volumes", []) if volume[:2] == "./"
    ]
    assert mounted
    assert [name for name in mounted if not (DEPLOY / name).exists()] == []
    copied = re.findall(r"^COPY (?!--from)(.*) \S+$", (DEPLOY / "Dockerfile").read_text(encoding="utf-8"), re.MULTILINE)
    assert [name for line in copied for name in line.split() if not (ROOT / name).exists()] == []


def test_prometheus_asks_the_port_that_ray_is_given(services: dict) -> None:
    config = yaml.safe_load((DEPLOY / "prometheus" / "prometheus.yml").read_text(encoding="utf-8"))
    [target] = config["scrape_configs"][0]["static_configs"][0]["targets"]
    host, port = target.split(":")
    assert f"--metrics-export-port={port}" in str(services[host]["command"])
