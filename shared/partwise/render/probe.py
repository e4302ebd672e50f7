"""Chooses the depth renderer that works on this machine.

A broken graphics driver may segfault or hang, so EGL is first tried in a process of its own
(`partwise.render.gl_probe`).
"""

import logging
import subprocess
import sys
from typing import Literal

from partwise.errors import ParameterError
from partwise.render.gl import GlRenderer
from partwise.render.raycast import RayCastRenderer
from partwise.render.views import DepthRenderer, RenderError

RendererPreference = Literal["auto", "gl", "raycast"]

_PROBE_COMMAND = (sys.executable, "-m", "partwise.render.gl_probe")
_LOG = logging.getLogger(__name__)


def open_depth_renderer(preference: RendererPreference = "auto", timeout_s: float = 60.0) -> DepthRenderer:
    """A renderer of depth views; the caller closes it. Which one was chosen, and why, is logged.

    Parameters
    ----------
    preference : "gl" or "raycast" insists; "auto" takes GL where the probe succeeds and ray casting elsewhere.
    timeout_s : seconds that the probe may take before GL counts as unusable.

    Raises
    ------
    RenderError : "gl" was asked for and the probe fails.
    ParameterError : another preference.
    """
    if preference == "raycast":
        return _chosen(RayCastRenderer(), "asked for")
    if preference not in ("auto", "gl"):
        raise ParameterError(f"the renderer must be auto, gl or raycast but is {preference!r}; choose one of them")
    failure = gl_failure(_PROBE_COMMAND, timeout_s)
    if failure is None:
        return _chosen(GlRenderer(), "EGL probe succeeded")
    if preference == "gl":
        raise RenderError(f"renderer gl was asked for but {failure}; install libegl1 and a driver, or use raycast")
    return _chosen(RayCastRenderer(), failure)


def gl_failure(command: tuple[str, ...], timeout_s: float) -> str | None:
    """Why GL cannot be used, or None where the probe command ends well within timeout_s seconds."""
    try:
        ended = subprocess.run(  # noqa: S603 — a fixed command of our own
            command, capture_output=True, text=True, timeout=timeout_s, check=False
        )
    except subprocess.TimeoutExpired:
        return f"the EGL probe did not end within {timeout_s:g} s"
    except OSError as error:
        return f"the EGL probe did not start: {error}"
    if ended.returncode == 0:
        return None
    last_line = (ended.stderr.strip().splitlines() or ["no message"])[-1]
    cause = f"signal {-ended.returncode}" if ended.returncode < 0 else f"exit code {ended.returncode}"
    return f"the EGL probe ended with {cause}: {last_line}"


def _chosen(renderer: DepthRenderer, reason: str) -> DepthRenderer:
    _LOG.info("depth renderer %s: %s", renderer.name, reason, extra={"renderer": renderer.name, "reason": reason})
    return renderer
