"""Random lamps: table, floor, arc, tripod, desk and gooseneck lamps. Parts: base, stem, shade."""

import itertools

import numpy as np

from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Box, Ellipsoid, Frustum, Placed, Rod, Solid, Tube, Vector, place
from partwise.simulate.supports import column
from partwise.simulate.sweeps import Extrusion, Lathe, LatheShell, Outline, smooth_curve, superellipse

LAMP_PARTS = ("base", "stem", "shade")

_WALL = 0.024  # of a shade: thick for a lamp, but a grid must see it


def random_lamp(rng: np.random.Generator) -> Blueprint:
    """A lamp 0.5 to 1.6 units tall, standing on y = 0; those with a head look to +z."""
    makers = (_table_lamp, _floor_lamp, _tripod_lamp, _arc_lamp, _desk_lamp, _gooseneck_lamp)
    maker = makers[int(rng.choice(len(makers), p=[0.32, 0.18, 0.1, 0.12, 0.16, 0.12]))]
    pieces = maker(rng)
    deformation = Deformation(
        taper=rng.normal(0.0, 0.08),
        twist=rng.normal(0.0, 0.1),
        lean=rng.normal(0.0, 0.02),
        ripples=random_ripples(rng, rng.uniform(0.002, 0.016)),
    )
    return Blueprint(pieces, blend=rng.uniform(0.005, 0.022), deformation=deformation)


def _table_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """A turned or boxy body that a short stem joins to a broad shade."""
    body_height = rng.uniform(0.2, 0.42)
    body = _body(rng, body_height)
    shade_radius = rng.uniform(0.16, 0.28)
    shade_height = rng.uniform(0.15, 0.3)
    low = body_height + rng.uniform(0.06, 0.14)
    r = rng.uniform(0.013, 0.022)
    stem = column((0.0, body_height - 0.03, 0.0), (0.0, low + 0.7 * shade_height, 0.0), r, r)
    shades = _shade(rng, shade_radius, shade_height, (0.0, low, 0.0))
    return (*_pieces(body, "base"), Piece(stem, "stem"), *_pieces(shades, "shade"))


def _body(rng: np.random.Generator, height: float) -> tuple[Solid, ...]:
    kind = rng.choice(["vase", "box", "ball", "cone", "stack"], p=[0.4, 0.15, 0.15, 0.15, 0.15])
    wide = rng.uniform(0.08, 0.14)
    if kind == "vase":
        foot, waist, belly, neck = wide * rng.uniform([0.6, 0.35, 0.7, 0.2], [1.0, 0.9, 1.2, 0.4])
        at = np.sort(rng.uniform(0.12, 0.85, 2)) * height
        knots = ((foot, 0.0), (waist, float(at[0])), (belly, float(at[1])), (neck, height))
        profile = smooth_curve(knots, 24)
        return (Lathe(tuple((max(p[0], 0.02), p[1]) for p in profile)),)
    if kind == "box":
        half = (wide * rng.uniform(0.6, 1.1), height / 2, wide * rng.uniform(0.5, 1.0))
        return (place(Box(half, rng.uniform(0.005, 0.04)), (0.0, height / 2, 0.0)),)
    if kind == "ball":
        tall = height * 0.5
        foot = place(Frustum(0.015, 0.75 * wide, 0.7 * wide, 0.005), (0.0, 0.015, 0.0))
        return (foot, place(Ellipsoid((1.1 * wide, tall, 1.1 * wide)), (0.0, tall, 0.0)))
    if kind == "cone":
        low, high = (1.1, 0.3) if rng.random() < 0.7 else (0.6, 1.0)
        return (place(Frustum(height / 2, wide * low, wide * high, 0.01), (0.0, height / 2, 0.0)),)
    n = int(rng.integers(2, 4))
    r = height / (2 * n)
    radii = rng.uniform(0.7, 1.2, n) * r
    return tuple(
        place(Ellipsoid((1.15 * a, 1.15 * r, 1.15 * a)), (0.0, r * (2 * k + 1), 0.0)) for k, a in enumerate(radii)
    )


def _floor_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """A long pole on a plate, under a shade, a bowl or a globe."""
    foot = _foot(rng, rng.uniform(0.14, 0.22))
    top = rng.uniform(0.95, 1.3)
    r = rng.uniform(0.014, 0.024)
    stem = column((0.0, 0.01, 0.0), (0.0, top, 0.0), r * rng.uniform(1.0, 1.6), r)
    radius, height = rng.uniform(0.13, 0.24), rng.uniform(0.15, 0.32)
    shades = _shade(rng, radius, height, (0.0, top - 0.7 * height, 0.0))
    return (*_pieces(foot, "base"), Piece(stem, "stem"), *_pieces(shades, "shade"))


def _tripod_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Three legs for a base, that meet under a short stem and a shade."""
    n_legs = int(rng.choice([3, 3, 4]))
    apex, reach = rng.uniform(0.4, 0.85), rng.uniform(0.2, 0.34)
    r = rng.uniform(0.014, 0.022)
    turn = rng.uniform(0.0, np.pi)
    pieces = []
    for k in range(n_legs):
        angle = turn + 2.0 * np.pi * k / n_legs
        foot = (reach * np.cos(angle), r, reach * np.sin(angle))
        pieces.append(Piece(Rod(foot, (0.15 * foot[0], apex, 0.15 * foot[2]), 0.8 * r, 1.1 * r), "base"))
    hub = place(Frustum(0.025, 0.07, 0.06, 0.01), (0.0, apex, 0.0))
    radius, height = rng.uniform(0.16, 0.26), rng.uniform(0.18, 0.32)
    low = apex + rng.uniform(0.06, 0.16)
    stem = column((0.0, apex, 0.0), (0.0, low + 0.7 * height, 0.0), 1.1 * r, r)
    shades = _shade(rng, radius, height, (0.0, low, 0.0))
    return (*pieces, Piece(hub, "base"), Piece(stem, "stem"), *_pieces(shades, "shade"))


def _arc_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """A heavy foot and a pole that arches forward over a hanging shade."""
    top, reach = rng.uniform(0.95, 1.3), rng.uniform(0.4, 0.75)
    r = rng.uniform(0.014, 0.02)
    drop = rng.uniform(0.2, 0.4)
    rear = -0.25
    knots = (
        (0.0, 0.02, rear),
        (0.0, 0.6 * top, rear),
        (0.0, 0.97 * top, rear + 0.4 * reach),
        (0.0, top - drop, rear + reach),
    )
    path = _path(knots, 16)
    foot = [place(solid, (0.0, 0.0, rear)) for solid in _foot(rng, rng.uniform(0.14, 0.2))]
    radius, height = rng.uniform(0.1, 0.19), rng.uniform(0.1, 0.18)
    end = path[-1]
    head = _dome(rng, radius, height)
    tip = place(head, (end[0], end[1] - 0.6 * height, end[2]), pitch=rng.uniform(-0.5, 0.1))
    return (*_pieces(foot, "base"), Piece(Tube(path, (r,) * len(path)), "stem"), Piece(tip, "shade"))


def _desk_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Two or three straight arms with joints, and a head that looks down and forward."""
    foot = _foot(rng, rng.uniform(0.11, 0.17))
    r = rng.uniform(0.014, 0.02)
    angles = (rng.uniform(-0.7, -0.1), rng.uniform(0.4, 1.2))
    lengths = rng.uniform(0.25, 0.42, 2)
    joints: list[Vector] = [(0.0, 0.02, 0.0)]
    for angle, length in zip(angles, lengths, strict=True):
        _, y, z = joints[-1]
        joints.append((0.0, y + length * float(np.cos(angle)), z + length * float(np.sin(angle))))
    pieces = [Piece(Rod(a, b, r, r), "stem") for a, b in itertools.pairwise(joints)]
    knuckle = r * rng.uniform(1.4, 2.0)
    pieces += [Piece(place(Ellipsoid((knuckle,) * 3), joint), "stem") for joint in joints[1:2]]
    radius, height = rng.uniform(0.08, 0.13), rng.uniform(0.12, 0.2)
    pitch = rng.uniform(-0.9, 0.1)
    pieces.append(Piece(_hung(_dome(rng, radius, height), joints[-1], height, pitch), "shade"))
    return (*_pieces(foot, "base"), *pieces)


def _gooseneck_lamp(rng: np.random.Generator) -> tuple[Piece, ...]:
    """A bent tube from the foot to a bell or cone."""
    foot = _foot(rng, rng.uniform(0.1, 0.17))
    r = rng.uniform(0.013, 0.019)
    h, reach = rng.uniform(0.4, 0.65), rng.uniform(0.15, 0.34)
    sway = rng.uniform(-0.12, 0.05)
    knots = ((0.0, 0.02, 0.0), (0.0, 0.5 * h, sway), (0.0, h, 0.3 * reach), (0.0, 0.86 * h, reach))
    path = _path(knots, 16)
    radius, height = rng.uniform(0.07, 0.12), rng.uniform(0.1, 0.18)
    shade = _hung(_dome(rng, radius, height), path[-1], height, rng.uniform(-0.9, -0.1))
    return (*_pieces(foot, "base"), Piece(Tube(path, (r,) * len(path)), "stem"), Piece(shade, "shade"))


def _foot(rng: np.random.Generator, radius: float) -> tuple[Solid, ...]:
    """A plate on the floor: round, square or domed."""
    kind = rng.choice(["plate", "square", "dome", "puck"])
    if kind == "square":
        half = rng.uniform(0.016, 0.035)
        outline = superellipse(radius, radius * rng.uniform(0.6, 1.0), rng.uniform(4.0, 9.0))
        return (place(Extrusion(outline, half, 0.008), (0.0, half, 0.0)),)
    if kind == "dome":
        high = rng.uniform(0.06, 0.1)
        knots = ((radius, 0.0), (0.96 * radius, 0.02), (0.5 * radius, 0.8 * high), (0.1 * radius, high))
        return (Lathe(tuple((p[0], p[1]) for p in smooth_curve(knots, 12))),)
    half = rng.uniform(0.013, 0.02) if kind == "plate" else rng.uniform(0.03, 0.05)
    return (place(Frustum(half, radius, radius * rng.uniform(0.8, 1.0), 0.008), (0.0, half, 0.0)),)


def _shade(rng: np.random.Generator, radius: float, height: float, at: Vector) -> tuple[Solid, ...]:
    """A shade about the upright stem, its lower rim at `at`, and what holds it there."""
    kind = rng.choice(["drum", "cone", "bell", "globe", "bowl", "square"], p=[0.25, 0.28, 0.15, 0.12, 0.1, 0.1])
    x, y, z = at
    if kind == "globe":
        return (place(Ellipsoid((0.8 * radius, 0.55 * height + 0.03, 0.8 * radius)), (x, y + 0.7 * height, z)),)
    if kind == "square":
        top = rng.uniform(0.7, 1.0)
        outline = superellipse(0.85 * radius, top * 0.85 * radius, rng.uniform(5.0, 10.0))
        return (place(Extrusion(outline, height / 2, 0.012), (x, y + height / 2, z)),)
    narrowings = {"drum": (0.9, 1.0), "cone": (0.3, 0.75), "bell": (0.25, 0.5), "bowl": (1.2, 1.4)}
    top = rng.uniform(*narrowings[str(kind)])
    belly = (1.0 + top) / 2.0 - (0.12 if kind == "bell" else 0.0)
    if kind == "bowl":
        knots: Outline = ((0.03, 0.15 * height), (0.7 * radius, 0.4 * height), (1.1 * radius, height))
    else:
        knots = ((radius, 0.0), (belly * radius, 0.5 * height), (top * radius, height))
    shell: Solid = LatheShell(tuple((p[0], p[1]) for p in smooth_curve(knots, 14)), _WALL)
    if kind == "bowl":
        return (place(shell, (x, y + 0.5 * height, z)),)
    # A spider of three bars carries the shell. It stays inside the wall and lies where the stem ends.
    inner = belly * radius - 0.01
    turn = rng.uniform(0.0, np.pi)
    ends = [(inner * np.cos(turn + a), inner * np.sin(turn + a)) for a in np.arange(3) * 2.0 * np.pi / 3.0]
    spokes = [Rod((0.0, 0.55 * height, 0.0), (float(c), 0.5 * height, float(s)), 0.012, 0.012) for c, s in ends]
    return tuple(place(solid, at) for solid in (shell, *spokes))


def _dome(rng: np.random.Generator, radius: float, height: float) -> Solid:
    """A head that opens downwards, closed above, its crown at y = height."""
    neck = rng.uniform(0.15, 0.5)
    knots = (
        (radius, 0.0),
        (radius * rng.uniform(0.65, 1.0), 0.5 * height),
        (neck * radius, 0.92 * height),
        (0.0, height),
    )
    return LatheShell(tuple((max(p[0], 0.0), p[1]) for p in smooth_curve(knots, 12)), _WALL)


def _hung(head: Solid, end: Vector, height: float, pitch: float) -> Placed:
    """`head` tilted by `pitch`, its crown at `end`."""
    crown = place(head, (0.0, -0.97 * height, 0.0))
    return place(crown, end, pitch=pitch)


def _path(knots: tuple[Vector, ...], n_points: int) -> tuple[Vector, ...]:
    return tuple((p[0], p[1], p[2]) for p in smooth_curve(knots, n_points))


def _pieces(solids: tuple[Solid, ...] | list[Solid] | list[Placed], part: str) -> tuple[Piece, ...]:
    return tuple(Piece(solid, part) for solid in solids)
