"""Waiting for what another thread does."""
# ruff: noqa: S101 # tests assert

import threading
import time
from collections.abc import Callable

WITHIN_S = 60.0
"""Seconds after which a test takes it that something never comes."""


def wait_until(is_so: Callable[[], bool]) -> None:
    """Returns once it is so."""
    until = time.monotonic() + WITHIN_S
    while not is_so():
        assert time.monotonic() < until, "it never came to be"
        threading.Event().wait(0.005)
