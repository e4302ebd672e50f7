import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.features.light_field import (
    BLOCK_LENGTH,
    LIGHT_FIELD_LENGTH,
    N_BLOCKS,
    hog_of_views,
    light_field,
    light_field_distance,
)
from partwise.mesh import TriMesh
from partwise.render.gl import GlRenderer
from partwise.render.raycast import RayCastRenderer
from partwise.render.views import RenderError


def _shapes() -> dict[str, TriMesh]:
    shapes = {
        "ball": trimesh.creation.icosphere(subdivisions=3),
        "box": trimesh.creation.box(extents=(1, 2, 3)),
        "torus": trimesh.creation.torus(0.8, 0.3),
        "capsule": trimesh.creation.capsule(height=2.0, radius=0.3),
    }
    return {name: TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces)) for name, shape in shapes.items()}


def _descriptor(mesh: TriMesh) -> np.ndarray:
    return light_field(mesh, RayCastRenderer())


def test_the_length_is_the_documented_one() -> None:
    assert LIGHT_FIELD_LENGTH == 208_080
    descriptor = _descriptor(_shapes()["box"])
    assert descriptor.shape == (208_080,)
    assert descriptor.dtype == np.uint8


def test_empty_views_have_no_gradients() -> None:
    assert not hog_of_views(np.zeros((20, 144, 144), dtype=np.float32)).any()


def test_an_upright_edge_fills_the_bin_of_sideways_gradients_only() -> None:
    views = np.zeros((20, 144, 144), dtype=np.float32)
    views[:, :, 70:] = 1.0
    blocks = hog_of_views(views).reshape(N_BLOCKS, 4, 9)
    energy = blocks.sum(axis=(0, 1))
    # OpenCV centres its 9 bins between multiples of 20°, so a gradient at 0° is shared by the first and the last.
    assert energy[[0, 8]].sum() == pytest.approx(energy.sum())
    assert energy[0] == pytest.approx(energy[8])


def test_blocks_are_unit_vectors_at_most() -> None:
    values = hog_of_views(RayCastRenderer().depth_views(_shapes()["torus"]))
    assert values.min() >= 0.0
    assert np.linalg.norm(values.reshape(N_BLOCKS, BLOCK_LENGTH), axis=1).max() <= 1.0 + 1e-6


def test_quantisation_is_within_half_a_step() -> None:
    mesh = _shapes()["torus"]
    exact = hog_of_views(RayCastRenderer().depth_views(mesh))
    np.testing.assert_allclose(_descriptor(mesh) / 255.0, exact, atol=0.5 / 255 + 1e-6)


def test_scale_and_place_do_not_matter() -> None:
    mesh = _shapes()["torus"]
    moved = TriMesh(mesh.vertices * 40.0 + [7.0, -9.0, 2.0], mesh.faces)
    assert light_field_distance(_descriptor(mesh), _descriptor(moved)) < 0.02


def test_face_order_and_winding_do_not_matter() -> None:
    mesh = _shapes()["capsule"]
    shuffled = np.random.default_rng(0).permutation(mesh.faces)[:, ::-1]
    assert light_field_distance(_descriptor(mesh), _descriptor(TriMesh(mesh.vertices, shuffled))) < 0.02


def test_the_renderer_does_not_matter() -> None:
    try:
        renderer = GlRenderer()
    except RenderError as error:
        pytest.skip(f"no GL context can be made here: {error}")
    with renderer:
        drawn = {name: light_field(mesh, renderer) for name, mesh in _shapes().items()}
    cast = {name: _descriptor(mesh) for name, mesh in _shapes().items()}
    between_renderers = max(light_field_distance(drawn[name], cast[name]) for name in cast)
    between_shapes = min(light_field_distance(drawn[a], cast[b]) for a in drawn for b in cast if a != b)
    assert between_renderers < 0.1 * between_shapes


def test_the_distance_of_disjoint_unit_blocks_is_root_two() -> None:
    a, b = np.zeros(LIGHT_FIELD_LENGTH, dtype=np.uint8), np.zeros(LIGHT_FIELD_LENGTH, dtype=np.uint8)
    a[::BLOCK_LENGTH], b[1::BLOCK_LENGTH] = 255, 255
    assert light_field_distance(a, b) == pytest.approx(np.sqrt(2))


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_distance_is_a_metric(seed: int) -> None:
    a, b, c = np.random.default_rng(seed).integers(0, 256, (3, 2 * BLOCK_LENGTH)).astype(np.uint8)
    assert light_field_distance(a, a) == 0.0
    assert light_field_distance(a, b) == light_field_distance(b, a)
    assert light_field_distance(a, c) <= light_field_distance(a, b) + light_field_distance(b, c) + 1e-9
