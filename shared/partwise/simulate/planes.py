"""Random aeroplanes: airliners, light aircraft, fighters, gliders, biplanes. Parts: body, wing, tail, engine."""

import numpy as np

from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Box, Ellipsoid, Frustum, Mirrored, Placed, Rod, Solid, Vector, place
from partwise.simulate.sweeps import Lathe, Wing, smooth_curve

PLANE_PARTS = ("body", "wing", "tail", "engine")


def random_plane(rng: np.random.Generator) -> Blueprint:
    """A plane about 1.2 units long, its nose to +z, its body's axis on y = 0."""
    makers = (_airliner, _light_plane, _fighter, _glider, _biplane)
    pieces = makers[int(rng.choice(len(makers), p=[0.36, 0.22, 0.2, 0.1, 0.12]))](rng)
    deformation = Deformation(
        taper=rng.normal(0.0, 0.25),
        twist=rng.normal(0.0, 0.02),
        bow=rng.normal(0.0, 0.08),
        ripples=random_ripples(rng, rng.uniform(0.002, 0.014)),
    )
    return Blueprint(pieces, blend=rng.uniform(0.006, 0.026), deformation=deformation)


def _airliner(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Swept wings; two or four engines under them, two or three at the tail."""
    radius = rng.uniform(0.05, 0.1)
    body = _fuselage(rng, radius, nose=rng.uniform(0.12, 0.2), blunt=0.8)
    y = rng.uniform(-0.6, 0.0) * radius if rng.random() < 0.75 else 0.4 * radius
    root, z, span = rng.uniform(0.24, 0.34), rng.uniform(0.1, 0.24), rng.uniform(0.48, 0.68)
    sweep = rng.uniform(0.15, 0.36)
    wing = Wing(span, root, root * rng.uniform(0.25, 0.45), sweep, rng.uniform(0.0, 0.1), 0.045, 0.009)
    pieces = [Piece(body, "body"), *_both_sides(wing, (0.0, y, z), "wing")]
    where = rng.choice(["under2", "under4", "rear", "none"], p=[0.5, 0.2, 0.22, 0.08])
    size = rng.uniform(0.024, 0.042)
    if where == "rear":
        pieces += _rear_engines(rng, radius, size)
    elif where != "none":
        for share in (0.36,) if where == "under2" else (0.3, 0.58):
            at = (share * span, y + share * wing.dihedral - 1.5 * size, z - share * sweep + 0.02)
            pieces += _hung_engines(rng, at, size)
    is_t_tail = where == "rear" or rng.random() < 0.15
    return (*pieces, *_tail(rng, radius, is_t_tail=is_t_tail))


def _light_plane(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Straight wings, high or low, and a propeller in front or one on either wing."""
    radius = rng.uniform(0.06, 0.105)
    body = _fuselage(rng, radius, nose=rng.uniform(0.1, 0.16), blunt=0.9, slim=0.4)
    is_high = rng.random() < 0.5
    y = 0.85 * radius if is_high else -0.55 * radius
    root, span, z = rng.uniform(0.16, 0.24), rng.uniform(0.5, 0.72), rng.uniform(0.16, 0.3)
    wing = Wing(span, root, root * rng.uniform(0.5, 1.0), rng.uniform(0.0, 0.06), rng.uniform(0.0, 0.07), 0.06, 0.01)
    pieces = [Piece(body, "body"), *_both_sides(wing, (0.0, y, z), "wing")]
    canopy = place(Ellipsoid((0.75 * radius, 0.75 * radius, 0.17)), (0.0, 0.75 * radius, z - 0.1))
    pieces.append(Piece(canopy, "body"))
    if is_high and rng.random() < 0.6:
        for s in (-1.0, 1.0):
            low, high = (s * 0.5 * radius, -0.6 * radius, z - 0.1), (s * 0.45 * span, y, z - 0.1)
            pieces.append(Piece(Rod(low, high, 0.011, 0.011), "wing"))
    if rng.random() < 0.65:
        pieces += _propeller(rng, (0.0, 0.0, 0.58), 0.75 * radius, rng.uniform(0.13, 0.19))
    else:
        for s in (-1.0, 1.0):
            at = (s * 0.34 * span, y + 0.34 * wing.dihedral, z + 0.05)
            pod = place(Ellipsoid((0.036, 0.036, 0.14)), (at[0], at[1], at[2] - 0.03))
            pieces += [Piece(pod, "engine"), *_propeller(rng, (at[0], at[1], at[2] + 0.11), 0.02, 0.11)]
    return (*pieces, *_tail(rng, radius, is_t_tail=False))


def _fighter(rng: np.random.Generator) -> tuple[Piece, ...]:
    """A pointed body, delta or cropped wings, one fin or two, nozzles for engines."""
    radius = rng.uniform(0.05, 0.085)
    body = _fuselage(rng, radius, nose=rng.uniform(0.3, 0.45), blunt=0.25, slim=0.75)
    root = rng.uniform(0.38, 0.58)
    is_delta = rng.random() < 0.5
    tip = rng.uniform(0.04, 0.1) if is_delta else root * rng.uniform(0.25, 0.4)
    span = rng.uniform(0.3, 0.46)
    sweep = (root - tip) * (rng.uniform(0.85, 1.0) if is_delta else rng.uniform(0.5, 0.8))
    wing = Wing(span, root, tip, sweep, rng.uniform(-0.03, 0.03), 0.028, 0.009)
    z = rng.uniform(0.02, 0.14)
    pieces = [Piece(body, "body"), *_both_sides(wing, (0.0, rng.uniform(-0.3, 0.3) * radius, z), "wing")]
    canopy = place(Ellipsoid((0.032, 0.05, 0.13)), (0.0, 0.7 * radius, rng.uniform(0.2, 0.3)))
    pieces.append(Piece(canopy, "body"))
    n_nozzles = int(rng.choice([0, 1, 2], p=[0.2, 0.3, 0.5]))
    size = 0.62 * radius if n_nozzles == 2 else 1.05 * radius  # clearly more than the tail it sits on
    for x in {0: (), 1: (0.0,), 2: (-size, size)}[n_nozzles]:
        pieces.append(Piece(_along_z(Frustum(0.12, 0.8 * size, size, 0.008), (x, 0.0, -0.53)), "engine"))
    has_twin_fins = rng.random() < 0.45
    return (*pieces, *_fighter_tail(rng, radius, has_twin_fins, has_planes=not is_delta or rng.random() < 0.3))


def _glider(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Long thin wings, a slim boom, usually a T tail, no engine."""
    radius = rng.uniform(0.04, 0.065)
    body = _fuselage(rng, radius, nose=rng.uniform(0.15, 0.24), blunt=0.7, slim=0.28)
    root = rng.uniform(0.11, 0.15)
    wing = Wing(
        rng.uniform(0.72, 0.95),
        root,
        root * rng.uniform(0.4, 0.7),
        rng.uniform(0.0, 0.05),
        rng.uniform(0.02, 0.1),
        0.05,
        0.009,
    )
    pieces = [Piece(body, "body"), *_both_sides(wing, (0.0, 0.5 * radius, 0.26), "wing")]
    return (*pieces, *_tail(rng, radius, is_t_tail=rng.random() < 0.7, size=0.8))


def _biplane(rng: np.random.Generator) -> tuple[Piece, ...]:
    """Two wings above each other on struts, and a propeller."""
    radius = rng.uniform(0.055, 0.09)
    body = _fuselage(rng, radius, nose=0.08, blunt=0.95, slim=0.35)
    root, span, z = rng.uniform(0.15, 0.2), rng.uniform(0.42, 0.58), rng.uniform(0.26, 0.34)
    gap, stagger = rng.uniform(0.16, 0.22), rng.uniform(0.0, 0.06)
    lower = Wing(span * rng.uniform(0.8, 1.0), root, root * 0.9, rng.uniform(0.0, 0.05), 0.03, 0.04, 0.01)
    upper = Wing(span, root, root * 0.9, rng.uniform(0.0, 0.05), 0.02, 0.04, 0.01)
    low = -0.6 * radius
    pieces = [Piece(body, "body"), *_both_sides(lower, (0.0, low, z), "wing")]
    pieces += _both_sides(upper, (0.0, low + gap, z + stagger), "wing")
    for s in (-1.0, 1.0):
        for share in (0.14, 0.68):
            x, middle = s * share * span, z - 0.5 * root
            foot = (0.5 * x if share < 0.2 else x, low + 0.02, middle)
            pieces.append(Piece(Rod(foot, (x, low + gap, middle + stagger), 0.011, 0.011), "wing"))
    pieces += _propeller(rng, (0.0, 0.0, 0.58), 0.8 * radius, rng.uniform(0.13, 0.17))
    return (*pieces, *_tail(rng, radius, is_t_tail=False))


def _fuselage(rng: np.random.Generator, radius: float, nose: float, blunt: float, slim: float = 0.2) -> Solid:
    """A turned body from z = −0.6 to 0.6. nose : its length. blunt : 0 a spike, 1 a dome. slim : tail / full radius."""
    tail_start = rng.uniform(-0.25, 0.0)
    knots = (
        (0.004, 0.6),
        (radius * (0.3 + 0.45 * blunt), 0.6 - 0.25 * nose),
        (radius * (0.72 + 0.2 * blunt), 0.6 - 0.6 * nose),
        (radius, 0.6 - 1.1 * nose),
        (radius, tail_start),
        (radius * (slim + 1.0) / 2.0, (tail_start - 0.6) / 2.0),
        (max(radius * slim, 0.016), -0.6),
    )
    profile = [(max(p[0], 0.0), -p[1]) for p in smooth_curve(knots, 22)]
    # A lathe turns about y: its bottom becomes the nose.
    return place(Lathe(tuple((r, h) for r, h in profile)), (0.0, 0.0, 0.0), pitch=-np.pi / 2)


def _tail(rng: np.random.Generator, radius: float, *, is_t_tail: bool, size: float = 1.0) -> tuple[Piece, ...]:
    """A fin and two tail planes; a V or twin fins now and then."""
    height, chord = size * rng.uniform(0.15, 0.23), size * rng.uniform(0.14, 0.2)
    span, lag = size * rng.uniform(0.16, 0.26), rng.uniform(0.03, 0.14)
    z = -0.6 + chord + 0.03
    plane = Wing(span, 0.85 * chord, 0.5 * chord, lag, rng.uniform(0.0, 0.03), 0.035, 0.009)
    if not is_t_tail and rng.random() < 0.1:
        vee = Wing(1.3 * span, chord, 0.55 * chord, lag, 0.0, 0.035, 0.009)
        return tuple(Piece(_side(vee, s, (0.0, 0.0, z), roll=0.7), "tail") for s in (-1.0, 1.0))
    planes = _both_sides(plane, (0.0, height if is_t_tail else 0.2 * radius, z - (lag if is_t_tail else 0.0)), "tail")
    fin = Wing(height + 0.02, chord * 1.1, chord * (0.85 if is_t_tail else 0.5), lag, 0.0, 0.04, 0.01)
    if not is_t_tail and rng.random() < 0.12:
        low = Wing(0.8 * height, chord, 0.6 * chord, 0.5 * lag, 0.0, 0.04, 0.01)
        fins = [Piece(_upright(low, (s * 0.95 * span, -0.1 * height, z - lag)), "tail") for s in (-1.0, 1.0)]
        return (*planes, *fins)
    return (*planes, Piece(_upright(fin, (0.0, 0.0, z + 0.02)), "tail"))


def _fighter_tail(rng: np.random.Generator, radius: float, has_twin_fins: bool, has_planes: bool) -> tuple[Piece, ...]:
    chord = rng.uniform(0.17, 0.26)
    fin = Wing(rng.uniform(0.15, 0.23), chord, 0.4 * chord, rng.uniform(0.1, 0.2), 0.0, 0.03, 0.01)
    z = -0.56 + chord
    pieces = []
    if has_twin_fins:
        cant = rng.uniform(0.0, 0.35)
        for s in (-1.0, 1.0):
            pieces.append(Piece(_upright(fin, (s * 0.75 * radius, 0.2 * radius, z), lean=-s * cant), "tail"))
    else:
        pieces.append(Piece(_upright(fin, (0.0, 0.2 * radius, z)), "tail"))
    if has_planes:
        plane = Wing(rng.uniform(0.17, 0.24), 0.17, 0.08, rng.uniform(0.06, 0.14), 0.0, 0.03, 0.009)
        pieces += _both_sides(plane, (0.0, 0.0, -0.42), "tail")
    return tuple(pieces)


def _hung_engines(rng: np.random.Generator, at: Vector, size: float) -> list[Piece]:
    """A nacelle on a pylon under either wing."""
    length = size * rng.uniform(1.7, 2.6)
    pieces = []
    for s in (-1.0, 1.0):
        x, y, z = s * at[0], at[1], at[2]
        pieces.append(Piece(_nacelle(size, length, (x, y, z)), "engine"))
        pieces.append(
            Piece(place(Box((0.011, 0.8 * size, 0.6 * length), 0.005), (x, y + 1.1 * size, z - 0.02)), "engine")
        )
    return pieces


def _rear_engines(rng: np.random.Generator, radius: float, size: float) -> list[Piece]:
    """A nacelle on either flank before the tail, and now and then a third on top."""
    length, z = size * rng.uniform(1.9, 2.6), -0.33
    pieces = []
    for s in (-1.0, 1.0):
        x = s * (0.8 * radius + 1.25 * size)
        pieces.append(Piece(_nacelle(size, length, (x, 0.3 * radius, z)), "engine"))
        pieces.append(Piece(place(Box((size, 0.011, 0.5 * length), 0.005), (x - s * size, 0.3 * radius, z)), "engine"))
    return pieces


def _nacelle(radius: float, half_length: float, at: Vector) -> Placed:
    """A drum with a rounded mouth in front, narrower behind."""
    knots = (
        (0.72 * radius, -half_length),
        (0.98 * radius, -0.85 * half_length),
        (1.05 * radius, -0.2 * half_length),
        (0.6 * radius, half_length),
    )
    profile = tuple((p[0], p[1]) for p in smooth_curve(knots, 10))
    return place(Lathe(profile), at, pitch=-np.pi / 2)


def _propeller(rng: np.random.Generator, at: Vector, hub: float, reach: float) -> list[Piece]:
    """A cowl or hub with two to four blades in the xy plane."""
    n_blades = int(rng.integers(2, 5))
    turn = rng.uniform(0.0, np.pi)
    pieces = [Piece(place(Ellipsoid((hub, hub, 1.1 * hub)), (at[0], at[1], at[2] - 0.25 * hub)), "engine")]
    for k in range(n_blades):
        angle = turn + 2.0 * np.pi * k / n_blades
        blade = place(Box((reach / 2, 0.017, 0.011), 0.008), (reach / 2, 0.0, 0.0), pitch=0.3)
        pieces.append(Piece(place(blade, (at[0], at[1], at[2] + 0.7 * hub), roll=angle), "engine"))
    return pieces


def _both_sides(wing: Wing, at: Vector, part: str) -> list[Piece]:
    return [Piece(_side(wing, s, at), part) for s in (-1.0, 1.0)]


def _side(wing: Wing, side: float, at: Vector, roll: float = 0.0) -> Solid:
    """The wing on the right (side 1) or mirrored on the left (side −1), raised by `roll`."""
    return Mirrored(place(wing, at, roll=roll)) if side < 0 else place(wing, at, roll=roll)


def _upright(wing: Wing, at: Vector, lean: float = 0.0) -> Placed:
    """A wing that stands up as a fin; `lean` turns its tip to −x."""
    return place(wing, at, roll=np.pi / 2 + lean)


def _along_z(solid: Solid, at: Vector) -> Placed:
    return place(solid, at, pitch=np.pi / 2)
