"""Random mugs, cups and steins. Parts: body, handle."""

import itertools

import numpy as np

from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Rod, Solid, TorusArc, Tube, Vector, place
from partwise.simulate.sweeps import Extrusion, Lathe, Outline, smooth_curve, superellipse

MUG_PARTS = ("body", "handle")


def random_mug(rng: np.random.Generator) -> Blueprint:
    """A mug about 0.8 to 1.3 units tall, standing on y = 0, open above, its handle to one side."""
    height = rng.uniform(0.75, 1.25)
    wall = rng.uniform(0.045, 0.075)
    floor = rng.uniform(0.06, 0.12)
    if rng.random() < 0.12:
        body, hollow, profile = _square_body(rng, height, wall, floor)
    else:
        profile = _profile(rng, height)
        body = Lathe(profile)
        hollow = _hollow(profile, height, wall, floor)
    side = rng.choice([-1.0, 1.0])
    yaw = (0.0 if side > 0 else np.pi) + rng.normal(0.0, 0.25)
    pieces = [Piece(body, "body")]
    pieces += [Piece(place(solid, (0.0, 0.0, 0.0), yaw=yaw), "handle") for solid in _handle(rng, profile, height, wall)]
    deformation = Deformation(
        taper=rng.normal(0.0, 0.06),
        twist=rng.normal(0.0, 0.15),
        lean=rng.normal(0.0, 0.03),
        ripples=random_ripples(rng, rng.uniform(0.004, 0.035)),
    )
    return Blueprint(
        tuple(pieces), blend=rng.uniform(0.01, 0.07), deformation=deformation, carvings=(hollow,), wall=wall
    )


def _profile(rng: np.random.Generator, height: float) -> Outline:
    """Outer (radius, height) pairs, bottom to top: straight, conical, barrel, waisted, tulip, footed."""
    r = rng.uniform(0.32, 0.5)
    kind = rng.choice(["straight", "cone", "barrel", "waist", "tulip", "bowl"], p=[0.22, 0.2, 0.18, 0.14, 0.14, 0.12])
    shapes = {
        "straight": (1.0, 1.0, 1.0, 1.0),
        "cone": (rng.uniform(0.62, 0.8), 0.85, 0.95, rng.uniform(1.05, 1.15)),
        "barrel": (0.82, rng.uniform(1.05, 1.18), rng.uniform(1.05, 1.18), 0.88),
        "waist": (1.05, rng.uniform(0.8, 0.9), rng.uniform(0.8, 0.92), 1.05),
        "tulip": (0.65, 1.0, 0.92, 1.12),
        "bowl": (0.5, 0.98, 1.12, 1.2),
    }
    knots = tuple((r * f, y * height) for f, y in zip(shapes[str(kind)], (0.0, 0.33, 0.67, 1.0), strict=True))
    return tuple((p[0], p[1]) for p in smooth_curve(knots, 24))


def _hollow(profile: Outline, height: float, wall: float, floor: float) -> Lathe:
    """What is carved out: the profile moved in by the wall, from the floor to beyond the rim."""
    heights, radii = np.array([y for _, y in profile]), np.array([r for r, _ in profile])
    at = np.linspace(floor, height, 18)
    inner = np.interp(at, heights, radii) - wall
    # Round the bottom's edge a little, as a potter would.
    inner[0] -= 0.05
    return Lathe((*((float(r), float(y)) for r, y in zip(inner, at, strict=True)), (float(inner[-1]), height + 0.3)))


def _square_body(rng: np.random.Generator, height: float, wall: float, floor: float) -> tuple[Solid, Solid, Outline]:
    half = rng.uniform(0.32, 0.42)
    power = rng.uniform(4.0, 7.0)
    body = place(Extrusion(superellipse(half, half, power), height / 2, 0.02), (0.0, height / 2, 0.0))
    inside = superellipse(half - wall, half - wall, power)
    hollow = place(Extrusion(inside, height / 2 + 0.15), (0.0, floor + height / 2 + 0.15, 0.0))
    return body, hollow, ((half, 0.0), (half, height))


def _handle(rng: np.random.Generator, profile: Outline, height: float, wall: float) -> tuple[Solid, ...]:
    """A handle along +x whose ends lie inside the wall."""
    middle, half = height * rng.uniform(0.45, 0.58), height * rng.uniform(0.2, 0.33)
    r = rng.uniform(0.035, 0.06)
    reach = rng.uniform(0.2, 0.36)
    ends = [
        float(np.interp(y, [p[1] for p in profile], [p[0] for p in profile])) for y in (middle - half, middle + half)
    ]
    low, high = ((x - 0.35 * wall, y) for x, y in zip(ends, (middle - half, middle + half), strict=True))
    kind = rng.choice(["ring", "ear", "angular", "strap"], p=[0.28, 0.36, 0.2, 0.16])
    if kind == "ring":
        return (_ring(low, high, half, r, rng.uniform(0.9, 1.35)),)
    out = max(low[0], high[0]) + reach
    if kind == "angular":
        drop = rng.uniform(0.0, 0.12)
        a, b = (out, low[1] + drop), (out, high[1] - rng.uniform(0.0, 0.12))
        corners = [(*low, 0.0), (*a, 0.0), (*b, 0.0), (*high, 0.0)]
        return tuple(Rod(p, q, r, r) for p, q in itertools.pairwise(corners))
    droop = rng.uniform(-0.1, 0.1)
    knots: tuple[Vector, ...] = (
        (*low, 0.0),
        (0.45 * low[0] + 0.55 * out, low[1] + (0.02 + droop), 0.0),
        (out, middle - 0.25 * half + droop, 0.0),
        (out * rng.uniform(0.95, 1.0), middle + 0.6 * half, 0.0),
        (0.5 * high[0] + 0.5 * out, high[1] + 0.03, 0.0),
        (*high, 0.0),
    )
    path: tuple[Vector, ...] = tuple((p[0], p[1], p[2]) for p in smooth_curve(knots, 18))
    if kind == "ear":
        radii = tuple(float(v) for v in r * np.linspace(rng.uniform(0.8, 1.0), rng.uniform(0.95, 1.25), 18))
        return (Tube(path, radii),)
    # A strap: flat bars laid side by side along z.
    return tuple(Tube(tuple((x, y, z) for x, y, _ in path), (0.75 * r,) * 18) for z in (-0.8 * r, 0.0, 0.8 * r))


def _ring(low: tuple[float, float], high: tuple[float, float], half: float, r: float, openness: float) -> Solid:
    """Part of a torus through both ends; `openness` is about half its angle in quarter turns."""
    angle = min(openness * np.pi / 2, 0.75 * np.pi)
    ring_radius = half / float(np.sin(angle))
    centre_x = (low[0] + high[0]) / 2.0 - ring_radius * float(np.cos(angle))
    lean = float(np.arctan2(high[0] - low[0], high[1] - low[1]))
    return place(TorusArc(ring_radius, r, angle), (centre_x, (low[1] + high[1]) / 2.0, 0.0), roll=-lean)
