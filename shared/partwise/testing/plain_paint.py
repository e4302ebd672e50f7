"""The paint specification once more, in plain Python and as slowly as it reads: the oracle for every painter."""

import math
from collections import deque
from collections.abc import Collection, Sequence

Triple = tuple[float, float, float]


def plain_painted(
    vertices: Sequence[Sequence[float]],
    faces: Sequence[Sequence[int]],
    seeds: Sequence[int],
    radius: float,
    min_cosine: float | None = None,
    open_faces: Collection[int] | None = None,
) -> list[int]:
    """Faces painted, ascending. `vertices` must be float32 values; see `partwise.segmentation.paint` for the rest."""
    centroids = [_centroid(*(vertices[corner] for corner in face)) for face in faces]
    normals = [_normal(*(vertices[corner] for corner in face)) for face in faces]
    used = [vertices[corner] for face in faces for corner in face]
    extent = [max(point[k] for point in used) - min(point[k] for point in used) for k in range(3)]
    reach = radius * math.sqrt(_dot(extent, extent))
    owners = _owners(faces)
    painted: set[int] = set()
    for seed in dict.fromkeys(seeds):

        def is_taken(face: int, seed: int = seed) -> bool:
            offset = [centroids[face][k] - centroids[seed][k] for k in range(3)]
            if _dot(offset, offset) > reach * reach or (open_faces is not None and face not in open_faces):
                return False
            if min_cosine is None or face == seed:
                return True
            return _dot(normals[face], normals[seed]) >= min_cosine * (_length(normals[seed]) * _length(normals[face]))

        taken = {seed} if is_taken(seed) else set()
        queue = deque(taken)
        while queue:
            for edge in _edges(faces[queue.popleft()]):
                for face in owners[edge]:
                    if face not in taken and is_taken(face):
                        taken.add(face)
                        queue.append(face)
        painted |= taken
    return sorted(painted)


def _edges(face: Sequence[int]) -> list[tuple[int, int]]:
    pairs = [(face[0], face[1]), (face[1], face[2]), (face[2], face[0])]
    return [(min(pair), max(pair)) for pair in pairs if pair[0] != pair[1]]


def _owners(faces: Sequence[Sequence[int]]) -> dict[tuple[int, int], list[int]]:
    owners: dict[tuple[int, int], list[int]] = {}
    for index, face in enumerate(faces):
        for edge in _edges(face):
            owners.setdefault(edge, []).append(index)
    return owners


def _centroid(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> Triple:
    return ((a[0] + b[0]) + c[0]) / 3, ((a[1] + b[1]) + c[1]) / 3, ((a[2] + b[2]) + c[2]) / 3


def _normal(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> Triple:
    u = [b[k] - a[k] for k in range(3)]
    v = [c[k] - a[k] for k in range(3)]
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def _dot(u: Sequence[float], v: Sequence[float]) -> float:
    return (u[0] * v[0] + u[1] * v[1]) + u[2] * v[2]


def _length(u: Sequence[float]) -> float:
    return math.sqrt(_dot(u, u))
