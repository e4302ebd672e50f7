"""The service on one socket: in this process, or in several that this one starts, watches and ends."""

import gc
import logging
import os
import socket
import sys
from collections.abc import Callable
from functools import partial

import uvicorn
from fastapi import FastAPI
from uvicorn.config import STARTUP_FAILURE
from uvicorn.supervisors import Multiprocess

from partwise.errors import StoreError
from partwise_cli.logs import configure_logging
from partwise_cli.parent_death import end_with_parent
from partwise_cli.timely_heads import TimelyHeads
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

STOP_S = 5
SILENT_S = 60
"""Seconds after which a process that says nothing is replaced: more than a busy machine takes to load one."""

SWITCH_S = 0.0005
"""How long a thread computes before another may. A request waits for the interpreter after each of its statements: by
default 5 ms each time, while some thread folds strokes."""


def serve_on(settings: ServiceSettings, listener: socket.socket) -> None:
    """Serves until SIGINT or SIGTERM. Of several processes one that ends otherwise is started again.

    Raises
    ------
    StoreError : one of several processes cannot begin; it has logged why.
    KeyboardInterrupt : the end by SIGINT, where it is one process.
    """
    own_id = os.getpid() if settings.processes > 1 else None
    config = server_config(settings, partial(_app, settings, own_id))
    if own_id is None:
        uvicorn.Server(config).run(sockets=[listener])
        return
    supervisor = Multiprocess(config, sockets=[listener])
    supervisor.run()
    if any(process.exitcode == STARTUP_FAILURE for process in supervisor.processes):
        raise StoreError("each process of the service must be able to begin but one is not; its log above says why")


def server_config(settings: ServiceSettings, make_app: Callable[[], FastAPI]) -> uvicorn.Config:
    """How the application is served, which each process makes for itself."""
    return uvicorn.Config(
        make_app,
        factory=True,
        http=partial(TimelyHeads, head_s=settings.request_idle_s),  # type: ignore[arg-type] # it is called as the class is
        limit_concurrency=settings.max_connections,
        workers=settings.processes,
        log_config=None,
        log_level=logging.WARNING,
        access_log=False,
        server_header=False,
        proxy_headers=bool(settings.trusted_proxies),
        forwarded_allow_ips=list(settings.trusted_proxies),
        timeout_graceful_shutdown=STOP_S,
        timeout_worker_healthcheck=SILENT_S,
    )


def _app(settings: ServiceSettings, parent_id: int | None) -> FastAPI:
    """The application, in the process that serves it. parent_id : of who started that to serve; None for nobody."""
    if parent_id is not None:
        end_with_parent(parent_id)
        configure_logging(verbose=False)
    app = create_app(settings)
    gc.collect()
    gc.freeze()  # what is there by now stays: going through it again and again would hold requests up
    sys.setswitchinterval(SWITCH_S)
    return app
