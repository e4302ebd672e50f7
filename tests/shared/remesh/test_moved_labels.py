"""Labels on another mesh of the same shape, and how much of them came along."""

import numpy as np
import pytest

from partwise.errors import LabelError
from partwise.geometry.faces import face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.remesh.alpha_wrap import alpha_wrap
from partwise.remesh.decimate import decimate
from partwise.remesh.map_back import map_faces
from partwise.remesh.moved_labels import moved_labels
from partwise.remesh.parameters import AlphaWrap
from partwise.simulate.collection import simulate_shape
from partwise.testing.spheres import ball, halves, speckles

FINE, COARSE = ball(3), ball(2)


def test_labels_that_fit_come_along_whole() -> None:
    moved = moved_labels(FINE, COARSE, halves(FINE))
    assert moved.labels.dtype == np.uint16
    np.testing.assert_array_equal(moved.labels, halves(COARSE))
    assert moved.agreement > 0.98


def test_labels_too_fine_for_the_new_mesh_do_not_agree() -> None:
    assert moved_labels(FINE, COARSE, speckles(FINE)).agreement < 0.8


def test_agreement_is_of_the_labelled_area_alone() -> None:
    only_cap = np.where(face_centroids(FINE)[:, 2] > 0, speckles(FINE), 0).astype(np.uint16)
    everywhere = np.where(face_centroids(FINE)[:, 2] > 0, speckles(FINE), 3).astype(np.uint16)
    assert moved_labels(FINE, COARSE, only_cap).agreement < moved_labels(FINE, COARSE, everywhere).agreement


def test_no_labels_agree_wholly() -> None:
    moved = moved_labels(FINE, COARSE, np.zeros(FINE.n_faces, dtype=np.uint16))
    assert not moved.labels.any()
    assert moved.agreement == 1.0


def test_the_two_sides_of_a_thin_wall_are_told_apart_where_both_meshes_are_closed() -> None:
    flat = np.array([1.0, 1e-3, 1.0])
    thin, thinner = TriMesh(FINE.vertices * flat, FINE.faces), TriMesh(COARSE.vertices * flat, COARSE.faces)
    labels = np.where(face_centroids(thin)[:, 1] > 0, 1, 2).astype(np.uint16)
    expected = np.where(face_centroids(thinner)[:, 1] > 0, 1, 2)
    np.testing.assert_array_equal(moved_labels(thin, thinner, labels).labels, expected)


def test_labels_of_another_mesh_are_refused() -> None:
    with pytest.raises(LabelError, match="512 faces"):
        moved_labels(FINE, COARSE, halves(COARSE))


def test_known_labels_return_from_the_clean_design_by_the_remeshed_surface_to_the_dirty_file() -> None:
    right, total, shares = 0.0, 0.0, {}
    for category, seed in (("chairs", 0), ("lamps", 1), ("planes", 3), ("tables", 4)):
        clean, dirty = (simulate_shape(category, seed, category, dirty=d, n_faces=4_000) for d in (False, True))
        remeshed = decimate(alpha_wrap(dirty.mesh, AlphaWrap(1.5, 0.2)), 10_000).mesh
        assert remeshed is not None
        on_surface = moved_labels(clean.mesh, remeshed, (clean.labels + 1).astype(np.uint16)).labels
        returned = map_faces(remeshed, dirty.mesh, is_oriented=False).labels(on_surface.astype(np.int64))
        areas = face_areas(dirty.mesh)
        kept = areas[returned == dirty.labels + 1].sum()
        right, total, shares[category] = right + kept, total + areas.sum(), kept / areas.sum()
    worst = min(shares, key=lambda category: shares[category])
    assert right / total >= 0.98, f"{right / total:.2%} in all; worst: {worst}, {shares[worst]:.2%}"
    assert shares[worst] >= 0.95, f"worst: {worst}, {shares[worst]:.2%}"
