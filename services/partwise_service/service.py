"""`Service`: what is open while the application runs, for handlers to reach through `dependencies`."""

from collections.abc import Callable
from dataclasses import dataclass

from partwise.workspace.workspace import Workspace
from partwise_service.event_hub import EventHub
from partwise_service.maps import EmbeddingMaps
from partwise_service.ownership import KnownDraft
from partwise_service.remembered import Remembered
from partwise_service.schemas.operations import OpsOut
from partwise_service.schemas.queue import QueueDepthOut
from partwise_service.security.at_once import AtOnce
from partwise_service.security.rate_limit import FailureLimiter
from partwise_service.security.recent import RecentlyGood
from partwise_service.settings import ServiceSettings
from partwise_service.tool_pool import ToolPool


@dataclass(frozen=True, slots=True, eq=False)
class Service:
    """limiter : of failures to log in, by address and by a secret's beginning. recent : secrets good lately.

    known_draft : what never changes of a draft. replays : drafts that each person has read.
    replaying : processes for strokes of drafts, which do not wait behind tools. streams : of events that
    each token has open. clock : seconds, monotone.
    """

    settings: ServiceSettings
    workspace: Workspace
    limiter: FailureLimiter
    recent: RecentlyGood
    maps: EmbeddingMaps
    tools: ToolPool
    ops: Remembered[OpsOut]
    depths: Remembered[QueueDepthOut]
    events: EventHub
    known_draft: Callable[[int], KnownDraft]
    replays: AtOnce
    replaying: ToolPool
    streams: AtOnce
    clock: Callable[[], float]
