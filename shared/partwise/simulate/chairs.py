"""Random chairs and stools. Parts: seat, back, leg, arm; arms and backs are absent from some."""

import numpy as np

from partwise.simulate import supports
from partwise.simulate.backs import random_back
from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Box, Rod, Solid, Tube, place
from partwise.simulate.supports import Footing, beam
from partwise.simulate.sweeps import Extrusion, smooth_curve, superellipse

CHAIR_PARTS = ("seat", "back", "leg", "arm")

_FEET = (
    (supports.straight_legs, 0.36),
    (supports.curved_legs, 0.12),
    (supports.star_base, 0.14),
    (supports.disc_base, 0.07),
    (supports.sled_base, 0.1),
    (supports.cantilever_frame, 0.07),
    (supports.panel_legs, 0.08),
    (supports.cross_legs, 0.06),
)


def random_chair(rng: np.random.Generator) -> Blueprint:
    """A chair about 0.6 to 1.2 units tall, standing on y = 0, looking to +z; about one in twelve is a stool."""
    is_stool = rng.random() < 0.08
    is_heavy = not is_stool and rng.random() < 0.18
    half_x, half_z = rng.uniform(0.2, 0.3), rng.uniform(0.19, 0.29)
    if is_heavy:
        half_x, half_z = half_x + 0.06, half_z + 0.05
    height = rng.uniform(0.22, 0.34) if is_heavy else rng.uniform(0.36, 0.52)
    if is_stool:
        height = rng.uniform(0.35, 0.75)
    half_thickness = rng.uniform(0.05, 0.09) if is_heavy else rng.uniform(0.016, 0.04)
    top = height + half_thickness
    seat = _seat(rng, half_x, half_z, height, half_thickness)
    pieces = [Piece(solid, "seat") for solid in seat]
    pieces += [Piece(solid, "leg") for solid in _legs(rng, half_x, half_z, height, is_heavy)]
    if not is_stool:
        lean = rng.uniform(0.0, 0.3)
        back_height = rng.uniform(0.3, 0.62)
        back = random_back(rng, 0.96 * half_x, back_height, is_heavy)
        # The back starts inside the seat, so that they are one piece.
        foot = (0.0, height, -half_z + rng.uniform(0.02, 0.04))
        pieces += [Piece(place(solid, foot, pitch=-lean), "back") for solid in back]
        if is_heavy or rng.random() < 0.45:
            arms = _arms(rng, half_x, half_z, top, lean, is_heavy)
            pieces += [Piece(solid, "arm") for solid in arms]
    deformation = Deformation(
        taper=rng.normal(0.0, 0.1),
        twist=rng.normal(0.0, 0.03),
        lean=rng.normal(0.0, 0.03),
        bow=rng.normal(0.0, 0.1),
        pivot=height,
        ripples=random_ripples(rng, rng.uniform(0.002, 0.016)),
    )
    return Blueprint(tuple(pieces), blend=rng.uniform(0.006, 0.03), deformation=deformation)


def _seat(
    rng: np.random.Generator, half_x: float, half_z: float, height: float, half_thickness: float
) -> tuple[Solid, ...]:
    rounding = half_thickness * rng.uniform(0.2, 0.95)
    kind = rng.choice(["box", "trapezoid", "round", "squircle", "cushion"], p=[0.25, 0.25, 0.12, 0.2, 0.18])
    at = (0.0, height, 0.0)
    if kind == "box":
        return (place(Box((half_x, half_thickness, half_z), rounding), at),)
    if kind == "trapezoid":
        narrow = half_x * rng.uniform(0.7, 0.92)
        bulge = half_z + rng.uniform(0.0, 0.04)
        outline = ((-narrow, -half_z), (narrow, -half_z), (half_x, half_z), (0.0, bulge), (-half_x, half_z))
        return (place(Extrusion(outline, half_thickness, rounding), at),)
    if kind == "cushion":
        board = place(Box((half_x, 0.6 * half_thickness, half_z), 0.3 * half_thickness), at)
        pad = Box((0.94 * half_x, 1.2 * half_thickness, 0.94 * half_z), 1.1 * half_thickness)
        return (board, place(pad, (0.0, height + 1.1 * half_thickness, 0.0)))
    power = 2.2 if kind == "round" else rng.uniform(3.0, 6.0)
    return (place(Extrusion(superellipse(1.03 * half_x, 1.03 * half_z, power), half_thickness, rounding), at),)


def _legs(rng: np.random.Generator, half_x: float, half_z: float, height: float, is_heavy: bool) -> tuple[Solid, ...]:
    inset = rng.uniform(0.84, 0.94)
    girth = rng.uniform(0.022, 0.036) if is_heavy else rng.uniform(0.013, 0.027)
    footing = Footing(inset * half_x, inset * half_z, height, girth)
    if is_heavy:
        makers = (supports.straight_legs, supports.curved_legs, supports.sled_base, supports.star_base)
        return makers[int(rng.choice(4, p=[0.55, 0.15, 0.15, 0.15]))](rng, footing)
    makers_and_odds = tuple(zip(*_FEET, strict=True))
    chosen = int(rng.choice(len(_FEET), p=makers_and_odds[1]))
    return _FEET[chosen][0](rng, footing)


def _arms(
    rng: np.random.Generator, half_x: float, half_z: float, top: float, lean: float, is_heavy: bool
) -> tuple[Solid, ...]:
    rise = rng.uniform(0.14, 0.25)
    kind = rng.choice(["panel", "rest", "tube"], p=[0.75, 0.2, 0.05] if is_heavy else [0.1, 0.55, 0.35])
    rear = -half_z - np.tan(lean) * rise + 0.01  # where the back is at the height of the rest
    front = half_z * rng.uniform(0.45, 0.95)
    flare = rng.uniform(0.0, 0.04)
    solids: list[Solid] = []
    for side in (-1, 1):
        x = side * (half_x + rng.uniform(-0.005, 0.005))
        if kind == "panel":
            t = rng.uniform(0.04, 0.075) if is_heavy else rng.uniform(0.014, 0.025)
            low = top - rng.uniform(0.06, 0.1)
            depth = (front - rear) / 2
            box = Box((t, (top + rise - low) / 2, depth), 0.8 * t)
            solids.append(place(box, (x + side * 0.5 * t, (top + rise + low) / 2, (front + rear) / 2)))
        elif kind == "rest":
            solids += _rest(rng, side, x + side * flare, top, rise, front, rear)
        else:
            r = rng.uniform(0.013, 0.02)
            knots = (
                (x - side * 0.02, top - 0.02, 0.6 * front),
                (x + side * flare, top + 0.6 * rise, front),
                (x + side * flare, top + rise, 0.7 * front),
                (x - side * 0.02, top + rise, rear),
            )
            path = smooth_curve(knots, 12)
            solids.append(Tube(tuple((p[0], p[1], p[2]) for p in path), (r,) * 12))
    return tuple(solids)


def _rest(
    rng: np.random.Generator, side: int, x: float, top: float, rise: float, front: float, rear: float
) -> list[Solid]:
    """A rest that meets the back, on a post near its front."""
    half_width = rng.uniform(0.016, 0.035)
    y = top + rise
    rest = beam((x, y, front), (x - side * 0.025, y + rng.uniform(-0.02, 0.04), rear), half_width, 0.014, 0.01)
    post_z = front * rng.uniform(0.1, 0.9)
    r = rng.uniform(0.013, 0.02)
    return [rest, Rod((x - side * 0.05, top - 0.025, post_z * 0.9), (x, y, post_z), r, r)]
