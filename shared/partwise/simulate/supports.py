"""What furniture stands on: four legs of many kinds, stars, discs, sleds, panels, crosses. All reach from y = 0 up.

Every maker takes a `Footing` and gives solids that overlap whatever lies at the footing's height.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from partwise.simulate.primitives import Box, Frustum, Placed, Rod, Solid, Tube, Vector, place
from partwise.simulate.sweeps import Lathe, smooth_curve


@dataclass(frozen=True, slots=True)
class Footing:
    """Room for the supports: ±half_x, ±half_z on the floor, up to `height`; `girth` is a leg's usual half width."""

    half_x: float
    half_z: float
    height: float
    girth: float

    @property
    def corners(self) -> tuple[tuple[int, int], ...]:
        return ((-1, -1), (1, -1), (1, 1), (-1, 1))


def beam(start: Vector, end: Vector, half_x: float, half_z: float, rounding: float = 0.0) -> Placed:
    """Square bar between two points; its x axis stays as near the world's x as it can (z for bars along x)."""
    axis = np.subtract(end, start)
    length = float(np.linalg.norm(axis))
    rotation = _frame(axis / length)
    middle = np.add(start, end) / 2.0
    return Placed(Box((half_x, length / 2.0, half_z), rounding), rotation, _vector(middle))


def column(start: Vector, end: Vector, start_radius: float, end_radius: float, rounding: float = 0.004) -> Placed:
    """Round bar between two points with flat ends."""
    axis = np.subtract(end, start)
    length = float(np.linalg.norm(axis))
    middle = np.add(start, end) / 2.0
    return Placed(Frustum(length / 2.0, start_radius, end_radius, rounding), _frame(axis / length), _vector(middle))


def straight_legs(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Four legs, square or round, upright or splayed, even or tapered, with stretchers between some."""
    splay_x, splay_z = rng.choice([0.0, 1.0], 2) * rng.uniform(0.0, 0.12, 2)
    is_square = rng.random() < 0.5
    taper = rng.uniform(0.55, 1.1)
    girth = footing.girth
    tops, feet = [], []
    for sx, sz in footing.corners:
        x, z = sx * (footing.half_x - girth), sz * (footing.half_z - girth)
        inset = rng.uniform(0.98, 1.0)
        tops.append((x * inset, footing.height, z * inset))
        feet.append((x + sx * splay_x, 0.0, z + sz * splay_z))
    if is_square:
        legs: list[Solid] = [beam(foot, top, girth, girth, 0.3 * girth) for foot, top in zip(feet, tops, strict=True)]
    else:
        legs = [column(foot, top, girth * taper, girth) for foot, top in zip(feet, tops, strict=True)]
    if rng.random() < 0.4:
        legs += _stretchers(rng, feet, tops, 0.62 * girth)
    return tuple(legs)


def curved_legs(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Four cabriole or sabre legs that bulge outwards at the knee or sweep outwards at the foot."""
    knee, foot = rng.uniform(-0.02, 0.06), rng.uniform(0.0, 0.1)
    girth, h = footing.girth, footing.height
    legs = []
    for sx, sz in footing.corners:
        x, z = sx * (footing.half_x - girth), sz * (footing.half_z - girth)
        outward = np.array([sx, 0.0, sz]) / np.sqrt(2.0)
        knots = (
            np.array([x, h, z]),
            np.array([x, 0.72 * h, z]) + knee * outward,
            np.array([x, 0.3 * h, z]) - 0.3 * knee * outward,
            np.array([x, 0.8 * girth, z]) + foot * outward,
        )
        path = smooth_curve(tuple(_vector(k) for k in knots), 8)
        radii = tuple(float(r) for r in np.linspace(1.35 * girth, 0.8 * girth, 8))
        legs.append(Tube(tuple(_vector(np.array(p)) for p in path), radii))
    return tuple(legs)


def hairpin_legs(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Four legs, each a V of two thin rods that meet at the floor."""
    spread = rng.uniform(0.05, 0.09)
    r = max(0.6 * footing.girth, 0.011)
    legs = []
    for sx, sz in footing.corners:
        x, z = sx * (footing.half_x - r), sz * (footing.half_z - r)
        tops = ((x, footing.height, z - sz * spread), (x - sx * spread, footing.height, z))
        path = (tops[0], (x, r, z), tops[1])
        legs.append(Tube(path, (r, r, r)))
    return tuple(legs)


def star_base(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """A column on a star of three to six spokes, some on castors."""
    n_spokes = int(rng.integers(3, 7))
    reach = rng.uniform(0.85, 1.1) * max(footing.half_x, footing.half_z)
    girth = max(footing.girth, 0.018)
    has_castors = rng.random() < 0.5
    hub = rng.uniform(0.06, 0.14) * footing.height + 0.04
    low = 0.045 if has_castors else 0.9 * girth
    start = rng.uniform(0.0, 2.0 * np.pi)
    solids: list[Solid] = [column((0.0, hub - 0.03, 0.0), (0.0, footing.height, 0.0), 1.6 * girth, 1.2 * girth)]
    for k in range(n_spokes):
        angle = start + 2.0 * np.pi * k / n_spokes
        x, z = reach * np.cos(angle), reach * np.sin(angle)
        solids.append(Rod((0.0, hub, 0.0), (x, low, z), 1.15 * girth, 0.85 * girth))
        if has_castors:
            solids.append(place(Frustum(0.016, 0.028, 0.028, 0.006), (x, 0.028, z), yaw=-angle, pitch=np.pi / 2))
    return tuple(solids)


def disc_base(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """A column on a flat or domed round foot, or a flowing tulip."""
    foot = rng.uniform(0.55, 0.9) * min(footing.half_x, footing.half_z)
    girth = footing.girth * rng.uniform(1.0, 1.9)
    h = footing.height
    if rng.random() < 0.5:
        knots = ((foot, 0.0), (0.93 * foot, 0.03), (0.3 * foot + girth, 0.12 * h), (girth, 0.45 * h))
        top = (girth * rng.uniform(1.0, 2.4), h)
        profile = smooth_curve((*knots, top), 18)
        return (Lathe(tuple((max(p[0], 0.6 * girth), max(p[1], 0.0)) for p in profile)),)
    height = rng.uniform(0.025, 0.06)
    plate = place(Frustum(height / 2, foot, foot * rng.uniform(0.6, 1.0), 0.01), (0.0, height / 2, 0.0))
    return (plate, column((0.0, height / 2, 0.0), (0.0, h, 0.0), girth, girth))


def sled_base(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Two closed or open frames, one on either side, that slide on runners, joined by a bar or two."""
    r = max(0.75 * footing.girth, 0.013)
    x, z, h = footing.half_x - r, footing.half_z - r, footing.height
    lean = rng.uniform(-0.05, 0.06)
    is_square = rng.random() < 0.5
    solids: list[Solid] = []
    for side in (-x, x):
        corners = ((side, h, z - lean), (side, r, z), (side, r, -z), (side, h, -z + lean))
        if is_square:
            pairs = itertools.pairwise(corners)
            solids += [_overlong_beam(a, b, r) for a, b in pairs]
        else:
            solids.append(Tube(corners, (r,) * 4))
    if rng.random() < 0.6:
        bar_z = rng.choice([-z, 0.0, z])
        solids.append(Rod((-x, r, float(bar_z)), (x, r, float(bar_z)), 0.9 * r, 0.9 * r))
    return tuple(solids)


def panel_legs(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Two boards on edge, upright or leaning, with a rail between some."""
    t = footing.girth * rng.uniform(0.7, 1.2)
    lean = rng.choice([0.0, 1.0]) * rng.uniform(0.02, 0.08)
    depth = footing.half_z * rng.uniform(0.75, 0.98)
    solids: list[Solid] = []
    for side in (-1, 1):
        x = side * (footing.half_x - t)
        solids.append(beam((x, 0.0, 0.0), (x - side * lean, footing.height, 0.0), t, depth, 0.006))
    if rng.random() < 0.5:
        y = footing.height * rng.uniform(0.25, 0.7)
        solids.append(place(Box((footing.half_x - t, 0.035, 0.8 * t), 0.004), (0.0, y, 0.0)))
    return tuple(solids)


def cross_legs(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Two X frames, at the sides or at front and back, joined by a bar through the crossings."""
    g = footing.girth
    x, z, h = footing.half_x - g, footing.half_z - g, footing.height
    is_round = rng.random() < 0.4
    at_sides = rng.random() < 0.5
    solids: list[Solid] = []
    for side in (-1, 1):
        for lean in (-1, 1):
            foot = (side * x, 0.0, lean * z) if at_sides else (lean * x, 0.0, side * z)
            top = (side * x, h, -lean * z) if at_sides else (-lean * x, h, side * z)
            solids.append(Rod(foot, top, g, g) if is_round else beam(foot, top, g, g, 0.25 * g))
    end = (x, h / 2, 0.0) if at_sides else (0.0, h / 2, z)
    solids.append(Rod((-end[0], end[1], -end[2]), end, 0.8 * g, 0.8 * g))
    return tuple(solids)


def cantilever_frame(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """A bent tube: up at the front, along the floor, closed at the rear; nothing holds the rear of the seat."""
    r = max(0.8 * footing.girth, 0.015)
    x, z, h = footing.half_x - r, footing.half_z - r, footing.height
    bulge = rng.uniform(0.0, 0.06)
    knots: list[Vector] = []
    for side in (-1, 1):
        arm = [(side * x, h, -0.3 * z), (side * x, h, 0.75 * z), (side * x, 0.55 * h, z + bulge)]
        arm += [(side * x, r, 0.85 * z), (side * x, r, -z)]
        knots += arm if side < 0 else arm[::-1]
    return (Tube(tuple(knots), (r,) * len(knots)),)


def trestle(rng: np.random.Generator, footing: Footing) -> tuple[Solid, ...]:
    """Two uprights on feet that run front to back, joined by a rail."""
    g = footing.girth * 1.2
    x, z, h = footing.half_x * rng.uniform(0.6, 0.85), footing.half_z * rng.uniform(0.75, 0.95), footing.height
    solids: list[Solid] = []
    for side in (-1, 1):
        solids.append(place(Box((g, 0.8 * g, z), 0.4 * g), (side * x, 0.8 * g, 0.0)))
        solids.append(place(Box((g, h / 2, rng.uniform(1.3, 3.0) * g), 0.3 * g), (side * x, h / 2, 0.0)))
    solids.append(place(Box((x, 1.2 * g, 0.6 * g), 0.2 * g), (0.0, h * rng.uniform(0.3, 0.7), 0.0)))
    return tuple(solids)


def _stretchers(rng: np.random.Generator, feet: list[Vector], tops: list[Vector], half_width: float) -> list[Solid]:
    """Bars between neighbouring legs: all four, two sides, or an H."""
    t = rng.uniform(0.2, 0.5)
    at = [_vector(np.array(foot) + t * np.subtract(top, foot)) for foot, top in zip(feet, tops, strict=True)]
    r = max(half_width, 0.011)
    layout = rng.choice(["all", "sides", "h"])
    sides = [(0, 3), (1, 2)]
    pairs = [*sides, (0, 1), (2, 3)] if layout == "all" else sides
    bars: list[Solid] = [Rod(at[a], at[b], r, r) for a, b in pairs]
    if layout == "h":
        left, right = (_vector((np.array(at[a]) + np.array(at[b])) / 2.0) for a, b in sides)
        bars.append(Rod(left, right, r, r))
    return bars


def _overlong_beam(a: Vector, b: Vector, half_width: float) -> Placed:
    """A beam that runs on by its half width at both ends, so that two of them meet in a full corner."""
    along = np.subtract(b, a) / np.linalg.norm(np.subtract(b, a)) * half_width
    return beam(_vector(np.array(a) - along), _vector(np.array(b) + along), half_width, half_width, 0.2 * half_width)


def _frame(y_axis: np.ndarray) -> tuple[Vector, Vector, Vector]:
    """Rows of the rotation that takes +y to `y_axis`."""
    guide = np.array([1.0, 0.0, 0.0]) if abs(y_axis[0]) < 0.9 else np.array([0.0, 0.0, 1.0])
    x_axis = guide - (guide @ y_axis) * y_axis
    x_axis /= np.linalg.norm(x_axis)
    matrix = np.stack([x_axis, y_axis, np.cross(x_axis, y_axis)], axis=1)
    return (_vector(matrix[0]), _vector(matrix[1]), _vector(matrix[2]))


def _vector(values: np.ndarray) -> Vector:
    return (float(values[0]), float(values[1]), float(values[2]))
