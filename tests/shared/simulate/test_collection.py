"""Collections as a user gets them: clean, dirty, varied, repeatable."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.errors import DegenerateMeshError, LabelError, ParameterError
from partwise.geometry.faces import face_areas, face_centroids
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.simulate.collection import (
    CATEGORIES,
    LabelledShape,
    shape_seed,
    simulate_collection,
    simulate_shape,
)

TRIANGLE = TriMesh(np.eye(3), np.array([[0, 1, 2]]))


@cache
def shapes(category: str, *, dirty: bool = False) -> list[LabelledShape]:
    """Two of each are enough, and made only once."""
    return list(simulate_collection(category, 2, seed=3, dirty=dirty))


@pytest.mark.parametrize("category", sorted(CATEGORIES))
def test_clean_shapes_are_closed_manifolds_of_the_usual_size(category: str) -> None:
    for shape in shapes(category):
        assert manifold_report(shape.mesh).is_clean, shape.name
        assert 1_950 <= shape.mesh.n_faces <= 20_400


@pytest.mark.parametrize("category", sorted(CATEGORIES))
def test_dirty_shapes_have_every_fault(category: str) -> None:
    for shape in shapes(category, dirty=True):
        report = manifold_report(shape.mesh)
        assert report.n_components > len(set(shape.labels.tolist()))
        assert min(report.n_boundary_edges, report.n_nonmanifold_edges, report.n_misoriented_edges) > 0
        assert min(report.n_degenerate_faces, report.n_duplicate_faces) > 0


@pytest.mark.parametrize("dirty", [False, True])
def test_the_same_seed_makes_the_same_bytes(dirty: bool) -> None:
    a, b = shapes("lamps", dirty=dirty), list(simulate_collection("lamps", 2, seed=3, dirty=dirty))
    assert [shape.mesh.content_hash() for shape in a] == [shape.mesh.content_hash() for shape in b]
    assert all(np.array_equal(x.labels, y.labels) for x, y in zip(a, b, strict=True))


def test_another_seed_makes_another_shape() -> None:
    hashes = {simulate_shape("lamps", seed, "lamp", n_faces=1000).mesh.content_hash() for seed in range(3)}
    assert len(hashes) == 3


def test_a_shape_can_be_remade_alone_from_its_recorded_seed() -> None:
    shape = shapes("tables")[1]
    assert simulate_shape("tables", shape.seed, "again").mesh.content_hash() == shape.mesh.content_hash()


def test_a_shape_does_not_depend_on_how_many_there_are() -> None:
    alone = next(simulate_collection("lamps", 1, seed=3))
    assert alone.mesh.content_hash() == shapes("lamps")[0].mesh.content_hash()


@given(st.integers(0, 2**40), st.integers(0, 10**6))
@settings(max_examples=20)
def test_shape_seeds_fit_a_signed_column(seed: int, index: int) -> None:
    assert 0 <= shape_seed("mugs", seed, index) < 2**63


def test_categories_and_indices_have_seeds_of_their_own() -> None:
    seeds = {shape_seed(category, 1, index) for category in CATEGORIES for index in range(50)}
    assert len(seeds) == 50 * len(CATEGORIES)


def test_names_are_unique() -> None:
    assert [shape.name for shape in shapes("lamps")] == ["lamp-0000", "lamp-0001"]


@pytest.mark.parametrize("dirty", [False, True])
@pytest.mark.parametrize("n_faces", [1_500, 30_000])
def test_the_wanted_face_count_is_met(n_faces: int, dirty: bool) -> None:
    shape = simulate_shape("lamps", 12, "lamp", dirty=dirty, n_faces=n_faces)
    assert abs(shape.mesh.n_faces - n_faces) <= 0.02 * n_faces


def test_clean_and_dirty_twins_agree_on_where_parts_lie() -> None:
    clean, dirty = (shapes("chairs", dirty=is_dirty)[0] for is_dirty in (False, True))
    for part in range(4):
        mine, yours = clean.labels == part, dirty.labels == part
        assert mine.any() == yours.any()
        if mine.any():
            # The soup also has faces inside other parts, so only the middles are compared.
            middles = [
                np.average(face_centroids(s.mesh)[own], axis=0, weights=face_areas(s.mesh)[own])
                for s, own in ((clean, mine), (dirty, yours))
            ]
            np.testing.assert_allclose(*middles, atol=0.08)


def test_chair_legs_lie_below_seats_and_seats_below_backs() -> None:
    for shape in shapes("chairs"):
        height = face_centroids(shape.mesh)[:, 1]
        middles = [np.median(height[shape.labels == part]) for part in range(3) if (shape.labels == part).any()]
        order = [middles[k] for k in ((2, 0, 1) if len(middles) == 3 else (1, 0))]
        assert order == sorted(order)


def test_shapes_stand_on_the_floor() -> None:
    for category in ("chairs", "tables", "lamps", "mugs"):
        shape = shapes(category)[0]
        assert abs(float(shape.mesh.vertices[:, 1].min())) < 0.06, category


def test_some_chairs_lack_arms_and_some_have_them() -> None:
    parts = [{piece.part for piece in CATEGORIES["chairs"].draw(np.random.default_rng(s)).pieces} for s in range(40)]
    n_armed = sum("arm" in own for own in parts)
    assert 8 <= n_armed <= 32


@pytest.mark.parametrize("category", sorted(CATEGORIES))
def test_every_part_occurs_and_no_other(category: str) -> None:
    chosen = CATEGORIES[category]
    drawn = {piece.part for seed in range(60) for piece in chosen.draw(np.random.default_rng(seed)).pieces}
    assert drawn == set(chosen.part_names)


@pytest.mark.parametrize("n_shapes", [0, -1, 1_000_001])
def test_a_count_out_of_range_is_refused_at_once(n_shapes: int) -> None:
    with pytest.raises(ParameterError, match="1 to 1000000 shapes"):
        simulate_collection("mugs", n_shapes, seed=0)


def test_an_unknown_category_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ParameterError, match="chairs, tables, lamps, planes, mugs"):
        simulate_collection("cars", 1, seed=0)


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ParameterError, match="not negative"):
        simulate_collection("mugs", 1, seed=-1)
    with pytest.raises(ParameterError, match="not negative"):
        simulate_shape("mugs", -1, "mug")


@pytest.mark.parametrize("n_faces", [0, 999, 200_001])
def test_a_face_count_out_of_range_is_refused_at_once(n_faces: int) -> None:
    with pytest.raises(ParameterError, match="1000 to 200000 faces"):
        simulate_collection("mugs", 1, seed=0, n_faces=n_faces)


def test_labels_of_the_wrong_length_are_refused() -> None:
    with pytest.raises(LabelError, match="one entry for each"):
        LabelledShape("x", TRIANGLE, np.array([0, 0]), ("a",), 0)


@pytest.mark.parametrize("label", [-1, 1])
def test_labels_outside_the_parts_are_refused(label: int) -> None:
    with pytest.raises(LabelError, match="must index the 1 part names"):
        LabelledShape("x", TRIANGLE, np.array([label]), ("a",), 0)


def test_designs_that_never_work_end_in_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise DegenerateMeshError("not this one")

    monkeypatch.setattr("partwise.simulate.collection.realise", refuse)
    with pytest.raises(DegenerateMeshError, match="the last: not this one"):
        simulate_shape("mugs", 0, "mug")
