"""`ServiceSettings`: where the service listens, what it serves, and its limits. From the environment and arguments.

Nothing is read when a module is imported: `ServiceSettings.of` is called once, by whoever starts the service.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from partwise.errors import ConfigError
from partwise.workspace.ingest_prefixes import parse_prefixes

PREFIX = "PARTWISE_SERVICE_"
"""Of environment variables: `PARTWISE_SERVICE_PORT` sets `port`. Lists are separated by commas."""
MEBIBYTE = 1 << 20
BUILT_PAGE = Path(__file__).parent / "static"
"""Where the client's build puts its files."""


class ServiceSettings(BaseModel):
    """What the service is told when it starts. Every field may be set by an environment variable, see `PREFIX`.

    public_url : how browsers reach the service when it is not http://host:port, such as behind a proxy.
    cors_origins : pages of other origins that may call the service; none unless named, exactly.
    trusted_proxies : addresses whose X-Forwarded-For and -Proto are believed.
    session_h : hours after which a browser must log in again. login_code_s : seconds for which a login code is good.
    max_body_bytes, max_upload_bytes : of a request's body, and of one to a path that takes files.
    request_idle_s : seconds of silence after which a request that has not come as a whole is given up.
    request_total_s : seconds that the body of one may take, but for one that takes files.
    max_connections : of each process; further ones are told to come back. A page has one for events and a few more.
    processes : that serve on the one port. Each has its share of `max_auth_failures` and `tool_processes`, at least 1.
    max_auth_failures : that one address, or one token's beginning, may make in `auth_window_s` seconds.
    threads : handlers that run at once; each may hold a connection to the database.
    lease_s : seconds for which a claim or a heartbeat holds a shape.
    tool_processes : in which tools run. max_queued_tools : calls that may wait for one; more are told to come back.
    tool_shapes : prepared shapes that each of them keeps. tool_timeout_s : after which a call is given up.
    replay_timeout_s : after which the strokes of a draft are.
    max_uploads : that may wait in a collection. upload_ttl_h : hours after which one is gone.
    ingest_prefixes : folders by name, below which jobs may ingest; the workers read the same variable.
    page_folder : the built files of the annotation page.
    event_stream_s : seconds after which a stream of events ends, for the client to go on with another.
    max_event_streams : that one token may have open; a page has one.
    event_keep_h : hours after which events are forgotten; who resumes from before begins anew.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    workspace: Path
    host: str = "127.0.0.1"
    port: int = Field(8000, ge=0, le=65_535)
    public_url: str | None = None
    cors_origins: tuple[str, ...] = ()
    trusted_proxies: tuple[str, ...] = ()
    processes: int = Field(1, ge=1, le=64)
    session_h: float = Field(12.0, gt=0, le=24 * 31)
    login_code_s: float = Field(600.0, gt=0, le=3600)
    max_body_bytes: int = Field(4 * MEBIBYTE, ge=1024)
    max_upload_bytes: int = Field(1024 * MEBIBYTE, ge=1024)
    request_idle_s: float = Field(30.0, gt=0)
    request_total_s: float = Field(120.0, gt=0)
    max_connections: int = Field(2_000, ge=1)
    max_auth_failures: int = Field(20, ge=1)
    auth_window_s: float = Field(60.0, gt=0)
    threads: int = Field(12, ge=1, le=256)
    lease_s: float = Field(300.0, gt=0, le=86_400)
    tool_processes: int = Field(2, ge=1, le=64)
    max_queued_tools: int = Field(16, ge=0, le=10_000)
    tool_shapes: int = Field(16, ge=1, le=10_000)
    tool_timeout_s: float = Field(60.0, gt=0)
    replay_timeout_s: float = Field(900.0, gt=0)
    event_stream_s: float = Field(3600.0, ge=0)
    max_event_streams: int = Field(8, ge=1, le=10_000)
    event_keep_h: float = Field(72.0, gt=0, le=24 * 366)
    max_uploads: int = Field(8, ge=1, le=1_000)
    upload_ttl_h: float = Field(24.0, gt=0, le=24 * 31)
    ingest_prefixes: dict[str, Path] = Field(default_factory=dict)
    page_folder: Path = BUILT_PAGE

    @field_validator("cors_origins", "trusted_proxies", mode="before")
    @classmethod
    def _split(cls, value: Any) -> Any:
        return [part.strip() for part in value.split(",") if part.strip()] if isinstance(value, str) else value

    @field_validator("ingest_prefixes", mode="before")
    @classmethod
    def _parse_prefixes(cls, value: Any) -> Any:
        return dict(parse_prefixes(value)) if isinstance(value, str) else value

    @field_validator("public_url")
    @classmethod
    def _check_url(cls, value: str | None) -> str | None:
        return None if value is None else _origin(value)

    @field_validator("cors_origins")
    @classmethod
    def _check_origins(cls, value: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(_origin(origin) for origin in value)

    @classmethod
    def of(cls, environment: Mapping[str, str], **arguments: Any) -> Self:
        """Settings from `PARTWISE_SERVICE_…` variables; an argument that is not None goes before a variable.

        Raises
        ------
        ConfigError : an unknown variable of the prefix, or a value of the wrong kind or out of range.
        """
        given: dict[str, Any] = {
            name.removeprefix(PREFIX).lower(): value for name, value in environment.items() if name.startswith(PREFIX)
        }
        given |= {name: value for name, value in arguments.items() if value is not None}
        try:
            return cls(**given)
        except ValidationError as error:
            first = error.errors()[0]
            why = first["msg"].removeprefix("Value error, ")  # of a validator of ours, which says enough
            name = str(first["loc"][0]) if first["loc"] else "settings"
            raise ConfigError(
                f"the service's {name} ({PREFIX}{name.upper()}) is wrong: {why}; see docs/service.md"
            ) from error

    def share(self, limit: int) -> int:
        """Of a limit of the whole service, what each of its processes may use."""
        return max(1, limit // self.processes)

    @property
    def origin(self) -> str:
        """Where browsers reach the service, `scheme://host[:port]`."""
        return self.public_url or f"http://{_bracketed(self.host)}:{self.port}"

    @property
    def is_https(self) -> bool:
        return self.origin.startswith("https://")

    @property
    def page_origins(self) -> frozenset[str]:
        """Origins whose pages may use the session cookie to change something."""
        own = {self.origin}
        if self.host in ("127.0.0.1", "localhost", "::1") and self.public_url is None:
            own |= {f"http://{name}:{self.port}" for name in ("127.0.0.1", "localhost", "[::1]")}
        return frozenset(own | set(self.cors_origins))


def _origin(url: str) -> str:
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname or parts.path.strip("/") or parts.query:
        raise ValueError(f"an origin must look like https://labels.example.org but is {url!r}")
    if "*" in url or "@" in parts.netloc:
        raise ValueError(f"an origin must be exact, without * or user names, but is {url!r}")
    return f"{parts.scheme}://{parts.netloc.lower()}"


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
