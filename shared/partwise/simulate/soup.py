"""The dirty twin of a shape: its pieces contoured apart, as CAD soups are, and then damaged; labels stay right.

Pieces run through each other; some lie open, inside out, unwelded or doubled; there are T-junctions, edges with three
faces and faces without area.
"""

from dataclasses import dataclass

import fast_simplification
import numpy as np
from jaxtyping import Int

from partwise.geometry.adjacency import edge_components
from partwise.geometry.contouring import grid_over
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids, face_normals
from partwise.mesh import TriMesh
from partwise.simulate.blueprint import Blueprint
from partwise.simulate.contour import contour, tight_bounds
from partwise.simulate.realise import part_of_piece

_CELLS_PER_THICKNESS = 4.0
_N_CELLS = (14, 130)  # along a piece's longest side
_MIN_PIECE_FACES = 12
_ROOM_TO_REDUCE = 1.2  # how many times the wanted faces are contoured


@dataclass(frozen=True, slots=True, eq=False)
class _Soup:
    """Faces, their labels, and the vertices they use. Damage makes a new one."""

    vertices: np.ndarray
    faces: np.ndarray
    labels: np.ndarray


def realise_as_soup(
    blueprint: Blueprint, part_names: tuple[str, ...], n_faces: int, rng: np.random.Generator
) -> tuple[TriMesh, Int[np.ndarray, " m"]]:
    """A multi-component, open, non-manifold mesh of `n_faces` faces, and each face's part index, (m,) int64.

    Raises
    ------
    DegenerateMeshError : a piece is too thin for a grid, or carved away.
    """
    soup = _assemble(blueprint, part_names, int(0.9 * n_faces), rng)
    for damage in (_tear, _open_pieces, _flip, _unweld, _duplicate, _add_fins, _add_slivers):
        soup = damage(soup, rng)
    soup = _to_count(soup, n_faces, rng)
    used, faces = np.unique(soup.faces, return_inverse=True)
    return TriMesh(soup.vertices[used], faces.reshape(-1, 3)), soup.labels


def _assemble(blueprint: Blueprint, part_names: tuple[str, ...], n_faces: int, rng: np.random.Generator) -> _Soup:
    """Each piece contoured and reduced by itself, side by side."""
    parts = part_of_piece(blueprint, part_names)
    fine = [_contour_piece(blueprint, index) for index in range(len(parts))]
    # Modellers spend faces unevenly: a leg may be finer than a seat.
    weight = np.array([np.sqrt(face_areas(mesh).sum()) for mesh in fine]) * rng.lognormal(0.0, 0.6, len(fine))
    wanted = np.maximum(n_faces * weight / weight.sum(), _MIN_PIECE_FACES).astype(int)
    meshes = [
        _at_count(blueprint, index, mesh, int(n)) for index, (mesh, n) in enumerate(zip(fine, wanted, strict=True))
    ]
    offsets = np.cumsum([0, *(mesh.n_vertices for mesh in meshes[:-1])])
    return _Soup(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=True)]),
        np.repeat(parts, [mesh.n_faces for mesh in meshes]),
    )


def _contour_piece(blueprint: Blueprint, index: int, refinement: float = 1.0) -> TriMesh:
    """One piece on a grid that suits its thickness, `refinement` times as fine."""

    def field(points: np.ndarray) -> np.ndarray:
        return blueprint.piece_distance(index, points)

    bounds = tight_bounds(field, blueprint.piece_bounds(index))
    longest = float((bounds[1] - bounds[0]).max())
    spacing = np.clip(
        blueprint.piece_thickness(index) / _CELLS_PER_THICKNESS, longest / _N_CELLS[1], longest / _N_CELLS[0]
    )
    return contour(field, grid_over(bounds, float(spacing) / refinement))


def _at_count(blueprint: Blueprint, index: int, mesh: TriMesh, n_faces: int) -> TriMesh:
    """A piece reduced to about `n_faces` faces, contoured again where it has too few."""
    shortage = _ROOM_TO_REDUCE * n_faces / mesh.n_faces
    if shortage > 1.0:
        mesh = _contour_piece(blueprint, index, refinement=1.05 * float(np.sqrt(shortage)))
    if mesh.n_faces <= n_faces:
        return mesh
    vertices, faces = fast_simplification.simplify(
        mesh.vertices.copy(), mesh.faces.copy(), target_count=n_faces, agg=4
    )[:2]
    return TriMesh(vertices, faces)


def _tear(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """A few holes of up to 2 % of the diagonal, on one side only, so that no leg is cut in two."""
    mesh = TriMesh(soup.vertices, soup.faces)
    centroids, normals = face_centroids(mesh), face_normals(mesh)
    keep = np.ones(len(soup.faces), dtype=bool)
    for _ in range(int(rng.integers(3, 12))):
        middle = int(rng.integers(len(soup.faces)))
        radius = bounding_box_diagonal(mesh) * rng.uniform(0.004, 0.02)
        near = np.linalg.norm(centroids - centroids[middle], axis=1) < radius
        keep &= ~(near & (normals @ normals[middle] > 0.5) & (soup.labels == soup.labels[middle]))
    return _Soup(soup.vertices, soup.faces[keep], soup.labels[keep])


def _open_pieces(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """Some pieces lose what faces one way (an open bottom), unless that is most of them."""
    piece = _pieces_of(soup)
    is_chosen = rng.random(int(piece.max()) + 1) < 0.25
    gone = is_chosen[piece] & (face_normals(TriMesh(soup.vertices, soup.faces))[:, 1] < -0.9)
    share = np.bincount(piece, weights=gone) / np.bincount(piece)
    gone &= share[piece] < 0.35
    return _Soup(soup.vertices, soup.faces[~gone], soup.labels[~gone])


def _flip(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """About a fifth of the pieces, and one face in two hundred, turn inside out."""
    piece = _pieces_of(soup)
    turned = (rng.random(int(piece.max()) + 1) < 0.2)[piece] ^ (rng.random(len(piece)) < 0.005)
    return _Soup(soup.vertices, np.where(turned[:, None], soup.faces[:, ::-1], soup.faces), soup.labels)


def _unweld(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """Some pieces become triangles with vertices of their own; others crack along random faces."""
    piece = _pieces_of(soup)
    loose = (rng.random(int(piece.max()) + 1) < 0.2)[piece] | (rng.random(len(piece)) < 0.02)
    corners = soup.faces[loose].ravel()
    faces = soup.faces.copy()
    faces[loose] = len(soup.vertices) + np.arange(len(corners)).reshape(-1, 3)
    return _Soup(np.concatenate([soup.vertices, soup.vertices[corners]]), faces, soup.labels)


def _duplicate(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """One face in a hundred is there twice."""
    again = rng.choice(len(soup.faces), len(soup.faces) // 100 + 1, replace=False)
    return _append(soup, soup.vertices[:0], soup.faces[again], soup.labels[again])


def _add_fins(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """One face in two hundred grows a small third face on an edge."""
    on = rng.choice(len(soup.faces), len(soup.faces) // 200 + 1, replace=False)
    corners = soup.vertices[soup.faces[on]]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    tip = corners.mean(axis=1) + 0.3 * cross / np.sqrt(np.maximum(np.linalg.norm(cross, axis=1), 1e-300))[:, None]
    fins = np.stack([soup.faces[on, 0], soup.faces[on, 1], len(soup.vertices) + np.arange(len(on))], axis=1)
    return _append(soup, tip, fins, soup.labels[on])


def _add_slivers(soup: _Soup, rng: np.random.Generator) -> _Soup:
    """One face in three hundred gets a neighbour without area: two corners alike, or three in a row."""
    on = rng.choice(len(soup.faces), len(soup.faces) // 300 + 2, replace=False)
    a, b = soup.faces[on, 0], soup.faces[on, 1]
    collapsed = rng.random(len(on)) < 0.5
    collapsed[0] = True  # a midpoint is rarely exactly in line, so that one face at least has no area at all
    middles = len(soup.vertices) + np.arange(len(on))
    slivers = np.stack([a, b, np.where(collapsed, b, middles)], axis=1)
    halfway = (soup.vertices[a] + soup.vertices[b]) / 2.0
    return _append(soup, halfway, slivers, soup.labels[on])


def _to_count(soup: _Soup, n_faces: int, rng: np.random.Generator) -> _Soup:
    """Exactly `n_faces` faces: some dropped, or some split on one side of an edge only (T-junctions)."""
    if len(soup.faces) > n_faces:
        keep = np.sort(rng.choice(len(soup.faces), n_faces, replace=False))
        return _Soup(soup.vertices, soup.faces[keep], soup.labels[keep])
    while len(soup.faces) < n_faces:
        areas = face_areas(TriMesh(soup.vertices, soup.faces))
        n_missing = n_faces - len(soup.faces)
        large = np.argsort(-areas, kind="stable")[: max(len(areas) // 2, 1)]
        on = rng.choice(large, min(n_missing, len(large)), replace=False)
        a, b, c = soup.faces[on].T
        middle = len(soup.vertices) + np.arange(len(on))
        faces = soup.faces.copy()
        faces[on] = np.stack([a, middle, c], axis=1)
        halfway = (soup.vertices[a] + soup.vertices[b]) / 2.0
        split = _Soup(soup.vertices, faces, soup.labels)
        soup = _append(split, halfway, np.stack([middle, b, c], axis=1), soup.labels[on])
    return soup


def _append(soup: _Soup, vertices: np.ndarray, faces: np.ndarray, labels: np.ndarray) -> _Soup:
    return _Soup(
        np.concatenate([soup.vertices, vertices]),
        np.concatenate([soup.faces, faces]),
        np.concatenate([soup.labels, labels]),
    )


def _pieces_of(soup: _Soup) -> np.ndarray:
    return edge_components(TriMesh(soup.vertices, soup.faces))
