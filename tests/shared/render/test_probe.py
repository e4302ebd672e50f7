import logging
import sys

import pytest

from partwise.errors import ParameterError
from partwise.render import probe
from partwise.render.gl import GlRenderer
from partwise.render.gl_probe import main
from partwise.render.probe import gl_failure, open_depth_renderer
from partwise.render.views import RenderError

CRASH = (sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")


def test_ray_casting_can_be_insisted_on() -> None:
    with open_depth_renderer("raycast") as renderer:
        assert renderer.name == "raycast"


def test_gl_is_taken_where_the_probe_succeeds(gl_renderer: GlRenderer) -> None:
    with open_depth_renderer("auto") as renderer:
        assert renderer.name == gl_renderer.name


def test_a_crashing_driver_leads_to_ray_casting_and_is_logged(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(probe, "_PROBE_COMMAND", CRASH)
    with caplog.at_level(logging.INFO, probe.__name__), open_depth_renderer("auto") as renderer:
        assert renderer.name == "raycast"
    (record,) = [r for r in caplog.records if r.name == probe.__name__]
    assert record.__dict__["renderer"] == "raycast"
    assert "signal 11" in record.__dict__["reason"]


def test_gl_insisted_on_without_a_driver_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probe, "_PROBE_COMMAND", CRASH)
    with pytest.raises(RenderError, match="signal 11"):
        open_depth_renderer("gl")


def test_an_unknown_preference_is_refused() -> None:
    with pytest.raises(ParameterError, match="'vulkan'"):
        open_depth_renderer("vulkan")  # type: ignore[arg-type]


def test_a_failing_probe_gives_its_last_line() -> None:
    assert gl_failure((sys.executable, "-c", "import sys; sys.exit('no display')"), 60) == (
        "the EGL probe ended with exit code 1: no display"
    )


def test_a_silent_probe_says_so() -> None:
    assert str(gl_failure((sys.executable, "-c", "raise SystemExit(3)"), 60)).endswith("exit code 3: no message")


def test_a_hanging_probe_is_given_up() -> None:
    hang = (sys.executable, "-c", "import threading; threading.Event().wait()")
    assert gl_failure(hang, 0.5) == "the EGL probe did not end within 0.5 s"


def test_a_probe_that_cannot_start_counts_as_failure() -> None:
    assert str(gl_failure(("/no/such/program",), 1)).startswith("the EGL probe did not start")


def test_the_probe_accepts_a_correct_driver(gl_renderer: GlRenderer) -> None:
    assert main() is None


def test_the_probe_notices_a_wrong_picture(gl_renderer: GlRenderer, monkeypatch: pytest.MonkeyPatch) -> None:
    draw = GlRenderer.depth_views
    monkeypatch.setattr(GlRenderer, "depth_views", lambda self, mesh: draw(self, mesh)[:, ::-1])
    assert "draws wrongly" in str(main())
