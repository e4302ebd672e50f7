"""The promise of `DepthRenderer`, for each implementation, and that they agree."""

import os
from pathlib import Path

import numpy as np
import pytest
import trimesh

from partwise.mesh import TriMesh
from partwise.render.gl import GlRenderer
from partwise.render.raycast import RayCastRenderer
from partwise.render.views import DepthRenderer, RenderError, nearness, pixel_centres, view_frames


@pytest.fixture(params=["raycast", "gl"])
def renderer(request: pytest.FixtureRequest) -> DepthRenderer:
    return RayCastRenderer() if request.param == "raycast" else request.getfixturevalue("gl_renderer")


def test_a_sphere_looks_like_a_sphere_from_everywhere(renderer: DepthRenderer) -> None:
    sphere = trimesh.creation.icosphere(subdivisions=6)
    views = renderer.depth_views(TriMesh(np.asarray(sphere.vertices), np.asarray(sphere.faces)))
    x, y = np.meshgrid(pixel_centres(), pixel_centres())
    squared = x**2 + y**2
    expected = nearness(np.sqrt(np.clip(1 - squared, 0, None)))
    inside, outside = squared < 0.98**2, squared > 1.0
    np.testing.assert_allclose(views[:, inside], np.broadcast_to(expected[inside], views[:, inside].shape), atol=5e-3)
    assert not views[:, outside].any()


def test_rows_go_down_and_columns_go_right(renderer: DepthRenderer) -> None:
    """A small triangle held up-right-near of the second camera must appear top-right and bright."""
    frame = view_frames()[1]
    anchors = np.concatenate([np.eye(3), -np.eye(3)])  # invisible: they only hold the sphere in place
    spot = np.array([0.4, 0.4, 0.6]) @ frame
    corners = spot + 0.1 * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]) @ frame
    faces = np.concatenate([[[0, 1, 2]], np.repeat(np.arange(3, 9)[:, None], 3, axis=1)])
    view = renderer.depth_views(TriMesh(np.concatenate([corners, anchors]), faces))[1]
    rows, columns = np.nonzero(view)
    assert 36 < rows.mean() < 46  # y = 0.43 of the sphere: row (1 − 0.43)·72
    assert 98 < columns.mean() < 108  # x = 0.43
    np.testing.assert_allclose(view[rows, columns], nearness(np.array(0.6)), atol=2e-3)


def test_both_sides_of_a_face_are_drawn(renderer: DepthRenderer, meshes: dict[str, TriMesh]) -> None:
    mesh = meshes["one triangle"]
    turned = TriMesh(mesh.vertices, mesh.faces[:, ::-1])
    views = renderer.depth_views(mesh)
    assert views.any(axis=(1, 2)).all()
    np.testing.assert_array_equal(views > 0, renderer.depth_views(turned) > 0)


def test_views_have_the_promised_form(renderer: DepthRenderer, meshes: dict[str, TriMesh]) -> None:
    for mesh in meshes.values():
        views = renderer.depth_views(mesh)
        assert views.shape == (20, 144, 144)
        assert views.dtype == np.float32
        assert views.min() == 0.0
        assert views[views > 0].min() >= np.float32(1 / 255)
        assert views.max() <= 1.0


def test_drawing_again_gives_the_same(renderer: DepthRenderer, meshes: dict[str, TriMesh]) -> None:
    first = renderer.depth_views(meshes["open bowl"])
    renderer.depth_views(meshes["sphere"])
    np.testing.assert_array_equal(renderer.depth_views(meshes["open bowl"]), first)


@pytest.mark.parametrize(
    "name", ["sphere", "box", "torus far from the origin", "open bowl", "randomly oriented ring", "one triangle"]
)
def test_gl_and_ray_casting_agree(name: str, meshes: dict[str, TriMesh], gl_renderer: GlRenderer) -> None:
    _assert_agreement(meshes[name], gl_renderer)


@pytest.mark.parametrize("path", ["lpsb/Airplane/61.off", "lpsb/Human/1.off", "dirty/DeskLamp/D00090.obj"])
def test_gl_and_ray_casting_agree_on_real_shapes(path: str, gl_renderer: GlRenderer) -> None:
    if "PARTWISE_DATA" not in os.environ:
        pytest.skip("PARTWISE_DATA is unset, so there are no real shapes")
    shape = trimesh.load(Path(os.environ["PARTWISE_DATA"]) / path, process=False, force="mesh")
    _assert_agreement(TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces)), gl_renderer)


def test_a_closed_gl_renderer_refuses_to_draw(gl_renderer: GlRenderer, meshes: dict[str, TriMesh]) -> None:
    renderer = GlRenderer()
    renderer.close()
    renderer.close()
    with pytest.raises(RenderError, match="closed"):
        renderer.depth_views(meshes["box"])
    assert gl_renderer.depth_views(meshes["box"]).any(), "closing one context must not break another"


def test_an_unknown_gl_platform_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYOPENGL_PLATFORM", "etch-a-sketch")
    with pytest.raises(RenderError, match="etch-a-sketch"):
        GlRenderer()


def _assert_agreement(mesh: TriMesh, gl_renderer: GlRenderer) -> None:
    drawn, cast = gl_renderer.depth_views(mesh), RayCastRenderer().depth_views(mesh)
    assert ((drawn > 0) == (cast > 0)).mean() >= 0.999
    both = (drawn > 0) & (cast > 0)
    difference = np.abs(drawn[both] - cast[both])
    assert np.quantile(difference, 0.999) < 1e-3
