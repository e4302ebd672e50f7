"""Writes the golden files beside it: `python tests/golden/paint/make.py`. See README.md."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from partwise.testing.plain_paint import plain_painted

Mesh = tuple[np.ndarray, np.ndarray]
PROVENANCE = (
    "Meshes from tests/golden/paint/make.py; faces from partwise.testing.plain_paint, the specification in "
    "docs/segmentation.md word by word in plain Python, CPython 3.11 on x86-64; the page's TypeScript agrees."
)


def grid(n_columns: int, n_rows: int, place: Callable[[float, float], tuple[float, float, float]]) -> Mesh:
    """n_columns × n_rows squares, each two faces, mapped by `place` from [0, 1]²."""
    vertices = [place(i / n_columns, j / n_rows) for j in range(n_rows + 1) for i in range(n_columns + 1)]
    faces = []
    for j in range(n_rows):
        for i in range(n_columns):
            a = j * (n_columns + 1) + i
            b, c, d = a + 1, a + n_columns + 2, a + n_columns + 1
            faces += [[a, b, c], [a, c, d]]
    return np.array(vertices), np.array(faces)


def joined(*meshes: Mesh, is_welded: bool = False) -> Mesh:
    """One mesh of several; welded, equal vertices become one."""
    shifts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    vertices = np.concatenate([vertices for vertices, _ in meshes])
    faces = np.concatenate([faces + shift for (_, faces), shift in zip(meshes, shifts, strict=False)])
    if not is_welded:
        return vertices, faces
    unique, inverse = np.unique(vertices.astype(np.float32), axis=0, return_inverse=True)
    return unique, inverse.ravel()[faces]


def thin_wall() -> Mesh:
    """A closed plate of 1 × 1 × 0.01: front and back lie much nearer than any brush is wide."""
    front = grid(10, 10, lambda s, t: (s, t, 0.01))
    back = grid(10, 10, lambda s, t: (t, s, 0.0))
    sides = [
        grid(10, 1, lambda s, t: (s, 0.0, 0.01 * t)),
        grid(10, 1, lambda s, t: (1.0 - s, 1.0, 0.01 * t)),
        grid(10, 1, lambda s, t: (0.0, 1.0 - s, 0.01 * t)),
        grid(10, 1, lambda s, t: (1.0, s, 0.01 * t)),
    ]
    vertices, faces = joined(front, back, *sides)
    unique, inverse = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    return unique, inverse.ravel()[faces]


def sheets() -> Mesh:
    """Two parallel sheets 0.02 apart that touch nowhere, and a third whose corners lie on the first's, unwelded."""
    return joined(
        grid(8, 8, lambda s, t: (s, t, 0.0)),
        grid(8, 8, lambda s, t: (s, t, 0.02)),
        grid(8, 8, lambda s, t: (1.0 + s, t, 0.0)),
    )


def fold() -> Mesh:
    """A strip folded by 80° along x = 0, and then gently rising by steps of 9°."""
    angles = np.cumsum([0.0, 0.0, 0.0, 0.0, 80.0, 0.0, 0.0, 9.0, 9.0, 9.0, 9.0]) * math.pi / 180
    x = np.concatenate([[0.0], np.cumsum(np.cos(angles))]) * 0.1
    z = np.concatenate([[0.0], np.cumsum(np.sin(angles))]) * 0.1
    n = len(angles)
    return grid(n, 4, lambda s, t: (float(x[round(s * n)]), t * 0.4, float(z[round(s * n)])))


def book() -> Mesh:
    """Five pages on one spine: each edge of the spine has five faces."""
    pages = [
        grid(4, 6, lambda s, t, a=angle: (s * math.cos(a), s * math.sin(a), t))  # type: ignore[misc]
        for angle in (0.0, 0.5, 1.0, 2.0, 4.0)
    ]
    return joined(*pages, is_welded=True)


def ties() -> Mesh:
    """Coordinates that float32 rounds, on a regular grid: many centroids lie exactly at a brush's rim."""
    return grid(12, 12, lambda s, t: (1.2 * s + 0.1, 1.2 * t + 0.7, 0.3))


def scraps() -> Mesh:
    """A dented sheet with a face without area, one that repeats a vertex, a repeated face and an unused far vertex."""
    rng = np.random.default_rng(4)
    vertices, faces = grid(6, 6, lambda s, t: (s, t, float(0.05 * rng.standard_normal())))
    vertices = np.concatenate([vertices, [(0.5, 0.0, 0.0), (100.0, 100.0, 100.0)]])
    vertices[0], vertices[1] = (0.0, 0.0, 0.0), (1 / 6, 0.0, 0.0)
    return vertices, np.concatenate([faces, [[0, 1, len(vertices) - 2], [7, 7, 8], faces[20]]])


CASES: dict[str, tuple[Callable[[], Mesh], list[dict[str, Any]]]] = {
    "thin_wall": (
        thin_wall,
        [
            {"seeds": [110], "radius": 0.15},
            {"seeds": [0, 40, 44, 40], "radius": 0.1},
            {"seeds": [110], "radius": 0.15, "min_cosine": 0.5},
            {"seeds": [300], "radius": 1.0},
        ],
    ),
    "sheets": (
        sheets,
        [{"seeds": [54], "radius": 0.2}, {"seeds": [54, 182], "radius": 0.05}, {"seeds": [15], "radius": 0.3}],
    ),
    "fold": (
        fold,
        [
            {"seeds": [33], "radius": 0.5},
            {"seeds": [33], "radius": 0.5, "min_cosine": 0.5},
            {"seeds": [35], "radius": 1.0, "min_cosine": 0.97},
            {"seeds": [35], "radius": 1.0, "min_cosine": 1.0},
            {"seeds": [35], "radius": 1.0, "min_cosine": -1.0},
        ],
    ),
    "book": (
        book,
        [
            {"seeds": [0], "radius": 0.15},
            {"seeds": [8], "radius": 0.2, "min_cosine": 0.8},
            {"seeds": [100], "radius": 0.3, "closed": list(range(0, 48))},
        ],
    ),
    "ties": (ties, [{"seeds": [156], "radius": k / 120} for k in (5, 10, 20, 24, 30, 40, 50)]),
    "scraps": (
        scraps,
        [
            {"seeds": [72], "radius": 0.3, "min_cosine": 0.9},
            {"seeds": [20], "radius": 0.25, "min_cosine": 0.95},
            {"seeds": [73], "radius": 0.4},
            {"seeds": [74], "radius": 0.3, "closed": [20]},
            {"seeds": [20], "radius": 0.3, "closed": [20]},
        ],
    ),
}


def main() -> None:
    for name, (make, cases) in CASES.items():
        vertices, faces = make()
        vertices = vertices.astype(np.float32).astype(np.float64)
        solved = []
        for case in cases:
            closed = case.get("closed")
            is_open = None if closed is None else set(range(len(faces))) - set(closed)
            painted = plain_painted(
                vertices.tolist(), faces.tolist(), case["seeds"], case["radius"], case.get("min_cosine"), is_open
            )
            full = {"seeds": case["seeds"], "radius": case["radius"], "min_cosine": case.get("min_cosine")}
            solved.append({**full, "closed": closed, "faces": painted})
        document = {
            "provenance": PROVENANCE,
            "what": make.__doc__,
            "vertices": vertices.tolist(),
            "faces": faces.tolist(),
            "cases": solved,
        }
        lines = ",\n".join(f"{json.dumps(key)}: {_lines(value)}" for key, value in document.items())
        Path(__file__).with_name(f"{name}.json").write_text(f"{{\n{lines}\n}}\n")


def _lines(value: Any) -> str:
    if isinstance(value, list) and isinstance(value[0], dict):
        return "[\n" + ",\n".join(json.dumps(item) for item in value) + "\n]"
    return json.dumps(value, separators=(",", ":"))


if __name__ == "__main__":
    main()
