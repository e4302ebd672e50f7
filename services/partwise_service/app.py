"""`create_app`: the service as an ASGI application. Nothing exists until it is called."""

import re
import time
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import replace
from datetime import timedelta

from anyio.to_thread import current_default_thread_limiter
from fastapi import APIRouter, FastAPI
from fastapi.routing import APIRoute
from starlette.middleware.cors import CORSMiddleware

from partwise import __version__
from partwise.workspace.workspace import open_workspace
from partwise_service.compression import CompressionMiddleware
from partwise_service.event_hub import EventHub
from partwise_service.maps import EmbeddingMaps
from partwise_service.openapi import install_openapi
from partwise_service.ownership import known_drafts
from partwise_service.page import install_page
from partwise_service.problems import install_problems
from partwise_service.remembered import Remembered
from partwise_service.routes import (
    accepts,
    arrays,
    checks,
    collections,
    drafts,
    events,
    exports,
    failures,
    figures,
    jobs,
    leases,
    operations,
    parts,
    people,
    queue,
    reviews,
    session,
    shapes,
    tools,
    uploads,
)
from partwise_service.schemas.operations import OpsOut
from partwise_service.schemas.queue import QueueDepthOut
from partwise_service.security.at_once import AtOnce
from partwise_service.security.middleware import (
    API,
    BodyLimitMiddleware,
    BodyTimeMiddleware,
    FaultMiddleware,
    HeadersMiddleware,
)
from partwise_service.security.rate_limit import FailureLimiter
from partwise_service.security.recent import RecentlyGood
from partwise_service.service import Service
from partwise_service.settings import ServiceSettings
from partwise_service.tool_pool import PoolLimits, ToolPool

API_V1 = f"{API}v1"
ROUTERS: Sequence[APIRouter] = (
    drafts.router,
    leases.router,
    queue.router,
    arrays.router,
    shapes.router,
    session.router,
    collections.router,
    parts.router,
    reviews.router,
    accepts.router,
    checks.router,
    figures.router,
    operations.router,
    people.router,
    tools.router,
    jobs.router,
    exports.router,
    uploads.router,
    failures.router,
    events.router,
)
"""Every resource of the API. A route file is served once its router is in here. What people at work ask for all the
time comes first: a request is compared with one route after another until one fits."""
UPLOAD_PATH = re.compile(rf"{API_V1}/collections/[0-9]+/uploads")
"""Paths whose requests may be as large as `max_upload_bytes`, and take as long as that takes."""
OPS_S = 10.0
"""Seconds for which figures of operation and of the queue are kept: some are counted over all shapes."""
MAX_REPLAYS = 4
"""Drafts whose labels are made for one person at once."""
_METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")
_REQUEST_HEADERS = ("Authorization", "Content-Type", "If-Match", "If-None-Match", "Last-Event-ID")


def create_app(settings: ServiceSettings, clock: Callable[[], float] = time.monotonic) -> FastAPI:
    """The application. It opens the workspace when it starts and closes it when it ends.

    clock : seconds, monotone, for limits on failed logins and for how long a secret is trusted.
    """

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        current_default_thread_limiter().total_tokens = settings.threads
        async with AsyncExitStack() as resources:
            workspace = resources.enter_context(open_workspace(settings.workspace))
            limiter = FailureLimiter(settings.share(settings.max_auth_failures), settings.auth_window_s, clock)
            pool = ToolPool(workspace.array_url, _pool_limits(settings))
            resources.callback(pool.close)
            replaying = ToolPool(workspace.array_url, replace(pool.limits, timeout_s=settings.replay_timeout_s))
            resources.callback(replaying.close)
            recent = RecentlyGood(clock)
            hub = EventHub(workspace.catalog, timedelta(hours=settings.event_keep_h), recent, clock)
            await resources.enter_async_context(hub.running())
            ops, depths = Remembered[OpsOut](OPS_S, clock), Remembered[QueueDepthOut](OPS_S, clock)
            known = known_drafts(workspace.catalog)
            replays, streams = AtOnce(MAX_REPLAYS, "drafts read"), AtOnce(settings.max_event_streams, "event streams")
            app.state.service = Service(
                settings,
                workspace,
                limiter,
                recent,
                EmbeddingMaps(),
                pool,
                ops,
                depths,
                hub,
                known,
                replays,
                replaying,
                streams,
                clock,
            )
            yield

    app = FastAPI(
        title="Partwise",
        version=__version__,
        description="Collections of 3D shapes, their labels, and the queue of work on them.",
        openapi_url=f"{API_V1}/openapi.json",
        docs_url=None,  # its page would load scripts from elsewhere
        redoc_url=None,
        redirect_slashes=False,
        generate_unique_id_function=_operation_id,
        lifespan=lifespan,
    )
    for router in ROUTERS:
        app.include_router(router, prefix=API_V1)
    install_problems(app)
    install_openapi(app)
    install_page(app, settings.page_folder)
    _add_middleware(app, settings)
    return app


def _pool_limits(settings: ServiceSettings) -> PoolLimits:
    return PoolLimits(
        settings.share(settings.tool_processes),
        settings.max_queued_tools,
        settings.tool_shapes,
        settings.tool_timeout_s,
    )


def _operation_id(route: APIRoute) -> str:
    """The handler's name, which generated clients use for theirs."""
    return route.name


def _add_middleware(app: FastAPI, settings: ServiceSettings) -> None:
    """From the innermost to the outermost."""
    app.add_middleware(CompressionMiddleware)
    app.add_middleware(BodyLimitMiddleware, settings.max_body_bytes, settings.max_upload_bytes, UPLOAD_PATH)
    app.add_middleware(BodyTimeMiddleware, settings.request_idle_s, settings.request_total_s, UPLOAD_PATH)
    app.add_middleware(FaultMiddleware)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=_METHODS,
            allow_headers=_REQUEST_HEADERS,
            allow_credentials=True,
            expose_headers=("ETag", "Retry-After"),
        )
    app.add_middleware(HeadersMiddleware, settings.is_https)
