"""Settings from the environment and from arguments."""

from pathlib import Path

import pytest

from partwise.errors import ConfigError
from partwise_service.settings import ServiceSettings

WS = Path("ws")


def test_arguments_go_before_the_environment_and_both_before_defaults() -> None:
    environment = {"PARTWISE_SERVICE_PORT": "9000", "PARTWISE_SERVICE_HOST": "0.0.0.0", "PATH": "/bin"}  # noqa: S104
    settings = ServiceSettings.of(environment, workspace=WS, port=9001, host=None)
    assert (settings.port, settings.host, settings.session_h) == (9001, "0.0.0.0", 12)  # noqa: S104


def test_lists_are_separated_by_commas() -> None:
    environment = {"PARTWISE_SERVICE_CORS_ORIGINS": "https://a.example, https://B.example:8443"}
    settings = ServiceSettings.of(environment, workspace=WS)
    assert settings.cors_origins == ("https://a.example", "https://b.example:8443")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("PORT", "many"),
        ("PORT", "70000"),
        ("CORS_ORIGINS", "*"),
        ("CORS_ORIGINS", "https://*.example.org"),
        ("CORS_ORIGINS", "labels.example.org"),
        ("CORS_ORIGINS", "https://example.org/path"),
        ("PUBLIC_URL", "ftp://example.org"),
        ("PUBLIC_URL", "https://user@example.org"),
        ("SESSION_H", "0"),
        ("NO_SUCH_SETTING", "1"),
    ],
)
def test_what_is_wrong_is_named(name: str, value: str) -> None:
    with pytest.raises(ConfigError, match=f"PARTWISE_SERVICE_{name}"):
        ServiceSettings.of({f"PARTWISE_SERVICE_{name}": value}, workspace=WS)


def test_pages_reach_a_local_service_by_any_local_name() -> None:
    origins = ServiceSettings(workspace=WS, port=8001).page_origins
    assert origins == {"http://127.0.0.1:8001", "http://localhost:8001", "http://[::1]:8001"}


def test_behind_a_proxy_the_public_address_is_the_origin() -> None:
    settings = ServiceSettings(workspace=WS, public_url="https://labels.example.org")
    assert (settings.page_origins, settings.is_https) == ({"https://labels.example.org"}, True)


def test_an_ipv6_address_is_bracketed() -> None:
    assert ServiceSettings(workspace=WS, host="fe80::1", port=80).origin == "http://[fe80::1]:80"
