"""Random tables and desks. Parts: top, leg, shelf, drawer; shelves and drawers are absent from most."""

import numpy as np

from partwise.simulate import supports
from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Box, Clipped, Ellipsoid, Solid, place
from partwise.simulate.supports import Footing
from partwise.simulate.sweeps import Extrusion, superellipse

TABLE_PARTS = ("top", "leg", "shelf", "drawer")

_CENTRED = (supports.star_base, supports.disc_base)  # these stand under the middle
_SPREAD = (
    supports.straight_legs,
    supports.curved_legs,
    supports.hairpin_legs,
    supports.sled_base,
    supports.panel_legs,
    supports.cross_legs,
    supports.trestle,
)
_SPREAD_ODDS = (0.36, 0.12, 0.09, 0.11, 0.14, 0.08, 0.1)
_WITH_STORAGE = (supports.straight_legs, supports.sled_base, supports.panel_legs)


def random_table(rng: np.random.Generator) -> Blueprint:
    """A table 0.3 to 0.8 units tall and 0.5 to 1.5 wide, standing on y = 0; drawers open to +z."""
    height = rng.uniform(0.32, 0.8)
    half_x, half_z = rng.uniform(0.3, 0.75), rng.uniform(0.22, 0.45)
    is_centred = rng.random() < 0.22
    if is_centred:
        half_x = half_z = rng.uniform(0.25, 0.5)
    half_thickness = rng.uniform(0.013, 0.04)
    is_round = is_centred or rng.random() < 0.3
    pieces = [Piece(_top(rng, half_x, half_z, height, half_thickness, is_round), "top")]
    inset = rng.uniform(0.54, 0.64) if is_round else rng.uniform(0.8, 0.93)
    footing = Footing(inset * half_x, inset * half_z, height, rng.uniform(0.016, 0.036))
    if is_centred:
        solids = _CENTRED[int(rng.integers(2))](rng, footing)
    else:
        kind = int(rng.choice(len(_SPREAD), p=_SPREAD_ODDS))
        solids = _SPREAD[kind](rng, footing)
        if not is_round and _SPREAD[kind] in _WITH_STORAGE:
            pieces += _storage(rng, footing, half_thickness)
    pieces += [Piece(Clipped(solid, 0.0, height), "leg") for solid in solids]
    deformation = Deformation(
        taper=rng.normal(0.0, 0.12),
        twist=rng.normal(0.0, 0.05),
        bow=rng.normal(0.0, 0.04),
        pivot=height,
        ripples=random_ripples(rng, rng.uniform(0.002, 0.018)),
    )
    return Blueprint(tuple(pieces), blend=rng.uniform(0.005, 0.028), deformation=deformation)


def _top(
    rng: np.random.Generator, half_x: float, half_z: float, height: float, half_thickness: float, is_round: bool
) -> Solid:
    rounding = half_thickness * rng.uniform(0.15, 0.95)
    at = (0.0, height, 0.0)
    if is_round:
        n_sides = int(rng.choice([28, 28, 28, 8, 6]))
        power = rng.uniform(2.0, 2.8) if n_sides == 28 else 2.0
        return place(Extrusion(superellipse(half_x, half_z, power, n_sides), half_thickness, rounding), at)
    if rng.random() < 0.35:
        return place(Extrusion(superellipse(half_x, half_z, rng.uniform(4.0, 8.0)), half_thickness, rounding), at)
    return place(Box((half_x, half_thickness, half_z), rounding), at)


def _storage(rng: np.random.Generator, footing: Footing, half_thickness: float) -> list[Piece]:
    """Between the legs: nothing, a shelf, drawers under the top, or one column of drawers down a side."""
    kind = rng.choice(["none", "shelf", "drawers", "column", "both"], p=[0.2, 0.3, 0.22, 0.18, 0.1])
    pieces: list[Piece] = []
    if kind in ("shelf", "both"):
        y = footing.height * rng.uniform(0.18, 0.45)
        t = rng.uniform(0.012, 0.02)
        pieces.append(Piece(place(Box((footing.half_x, t, footing.half_z), 0.5 * t), (0.0, y, 0.0)), "shelf"))
    if kind in ("drawers", "both"):
        n_drawers = int(rng.integers(1, 4))
        depth = rng.uniform(0.05, 0.09)
        wide = (footing.half_x - 1.5 * footing.girth) / n_drawers
        for k in range(n_drawers):
            x = -wide * n_drawers + wide * (2 * k + 1)
            y = footing.height - half_thickness - depth + 0.02
            pieces += _drawer(rng, (x, y, 0.0), (0.94 * wide, depth, 0.94 * footing.half_z))
    if kind == "column":
        n_drawers = int(rng.integers(2, 4))
        tall = footing.height * rng.uniform(0.5, 0.85) / (2 * n_drawers)
        wide = footing.half_x * rng.uniform(0.25, 0.4)
        x = rng.choice([-1.0, 1.0]) * (footing.half_x - wide)
        for k in range(n_drawers):
            y = footing.height - half_thickness + 0.01 - tall * (2 * k + 1)
            pieces += _drawer(rng, (float(x), y, 0.0), (wide, tall + 0.006 * (k % 2), 0.9 * footing.half_z))
    return pieces


def _drawer(rng: np.random.Generator, at: tuple[float, float, float], half: tuple[float, float, float]) -> list[Piece]:
    """A box with a knob or a bar on its front."""
    box = place(Box((half[0], half[1], half[2]), 0.008), at)
    front = (at[0], at[1], at[2] + half[2] + 0.008)
    handle: Solid
    if rng.random() < 0.5:
        handle = place(Ellipsoid((0.016, 0.016, 0.02)), front)
    else:
        handle = place(Box((min(0.3 * half[0], 0.07), 0.011, 0.02), 0.008), front)
    return [Piece(box, "drawer"), Piece(handle, "drawer")]
