"""Random chairs and stools. Parts: seat, back, leg, arm; arms and backs are absent from some."""

from dataclasses import dataclass

import numpy as np

from partwise.simulate import supports
from partwise.simulate.backs import random_back, random_wide_back, upholstered_back
from partwise.simulate.blueprint import Blueprint, Deformation, Piece, random_ripples
from partwise.simulate.primitives import Box, Clipped, Rod, Solid, Tube, place
from partwise.simulate.supports import Footing, beam
from partwise.simulate.sweeps import Extrusion, smooth_curve, superellipse

CHAIR_PARTS = ("seat", "back", "leg", "arm")

_LEGS = (
    supports.straight_legs,
    supports.curved_legs,
    supports.star_base,
    supports.disc_base,
    supports.sled_base,
    supports.cantilever_frame,
    supports.panel_legs,
    supports.cross_legs,
)
_LEG_ODDS = (0.34, 0.12, 0.14, 0.08, 0.1, 0.07, 0.08, 0.07)
_HEAVY_LEGS = (supports.straight_legs, supports.curved_legs, supports.sled_base, supports.star_base)
_HEAVY_LEG_ODDS = (0.55, 0.15, 0.15, 0.15)


@dataclass(frozen=True, slots=True)
class _Seat:
    """Extent of a seat about (0, height, 0), and its kind: box, cushion, trapezoid, round or squircle."""

    half_x: float
    half_z: float
    height: float
    half_thickness: float
    kind: str

    @property
    def top(self) -> float:
        return self.height + self.half_thickness


def random_chair(rng: np.random.Generator) -> Blueprint:
    """A chair about 0.6 to 1.2 units tall, standing on y = 0, looking to +z; about one in twelve is a stool."""
    is_stool = rng.random() < 0.08
    is_heavy = not is_stool and rng.random() < 0.18
    arm_kind = "none" if is_stool else _arm_kind(rng, is_heavy)
    seat = _random_seat(rng, is_stool, is_heavy, has_arms=arm_kind != "none")
    pieces = [Piece(solid, "seat") for solid in _seat_solids(rng, seat)]
    pieces += [Piece(solid, "leg") for solid in _legs(rng, seat, is_heavy)]
    if not is_stool:
        lean, height = rng.uniform(0.0, 0.3), rng.uniform(0.32, 0.62)
        # Arms that end at the back need one that is broad where they meet it.
        makers = {True: upholstered_back, False: random_wide_back if arm_kind in ("rest", "tube") else random_back}
        back = makers[is_heavy](rng, 0.96 * seat.half_x, height)
        # The back starts inside the seat, so that they are one piece.
        foot = (0.0, seat.height, -seat.half_z + rng.uniform(0.02, 0.04))
        pieces += [Piece(place(solid, foot, pitch=-lean), "back") for solid in back]
        pieces += [Piece(solid, "arm") for solid in _arms(rng, arm_kind, seat, lean, is_heavy)]
    deformation = Deformation(
        taper=rng.normal(0.0, 0.1),
        twist=rng.normal(0.0, 0.03),
        lean=rng.normal(0.0, 0.03),
        bow=rng.normal(0.0, 0.1),
        pivot=seat.height,
        ripples=random_ripples(rng, rng.uniform(0.002, 0.016)),
    )
    return Blueprint(tuple(pieces), blend=rng.uniform(0.006, 0.03), deformation=deformation)


def _arm_kind(rng: np.random.Generator, is_heavy: bool) -> str:
    if is_heavy:
        return str(rng.choice(["panel", "rest", "none"], p=[0.7, 0.15, 0.15]))
    return str(rng.choice(["none", "rest", "tube", "arch", "panel"], p=[0.54, 0.17, 0.1, 0.13, 0.06]))


def _random_seat(rng: np.random.Generator, is_stool: bool, is_heavy: bool, *, has_arms: bool) -> _Seat:
    half_x, half_z = rng.uniform(0.2, 0.3), rng.uniform(0.19, 0.29)
    height, half_thickness = rng.uniform(0.36, 0.52), rng.uniform(0.018, 0.042)
    if is_heavy:
        half_x, half_z = half_x + 0.06, half_z + 0.05
        height, half_thickness = rng.uniform(0.22, 0.34), rng.uniform(0.05, 0.09)
    if is_stool:
        height = rng.uniform(0.35, 0.75)
    kinds = ["box", "cushion", "trapezoid", "round", "squircle"]
    # Arms stand on the corners of a seat, so it needs some.
    odds = [0.4, 0.25, 0.35, 0.0, 0.0] if has_arms or is_heavy else [0.2, 0.15, 0.2, 0.2, 0.25]
    return _Seat(half_x, half_z, height, half_thickness, str(rng.choice(kinds, p=odds)))


def _seat_solids(rng: np.random.Generator, seat: _Seat) -> tuple[Solid, ...]:
    x, y, z = seat.half_x, seat.half_thickness, seat.half_z
    rounding = y * rng.uniform(0.2, 0.95)
    at = (0.0, seat.height, 0.0)
    if seat.kind == "box":
        return (place(Box((x, y, z), rounding), at),)
    if seat.kind == "trapezoid":
        narrow, bulge = x * rng.uniform(0.84, 0.95), z + rng.uniform(0.0, 0.04)
        outline = ((-narrow, -z), (narrow, -z), (x, z), (0.0, bulge), (-x, z))
        return (place(Extrusion(outline, y, rounding), at),)
    if seat.kind == "cushion":
        board = place(Box((x, 0.7 * y, z), 0.3 * y), at)
        pad = Box((0.94 * x, 1.2 * y, 0.94 * z), 1.1 * y)
        return (board, place(pad, (0.0, seat.height + 1.1 * y, 0.0)))
    power = 2.2 if seat.kind == "round" else rng.uniform(3.0, 6.0)
    return (place(Extrusion(superellipse(1.04 * x, 1.04 * z, power), y, rounding), at),)


def _legs(rng: np.random.Generator, seat: _Seat, is_heavy: bool) -> tuple[Solid, ...]:
    low, high = {"round": (0.64, 0.7), "squircle": (0.74, 0.82)}.get(seat.kind, (0.82, 0.93))
    inset = rng.uniform(low, high)
    girth = rng.uniform(0.022, 0.036) if is_heavy else rng.uniform(0.013, 0.027)
    footing = Footing(inset * seat.half_x, inset * seat.half_z, seat.height, girth)
    makers, odds = (_HEAVY_LEGS, _HEAVY_LEG_ODDS) if is_heavy else (_LEGS, _LEG_ODDS)
    solids = makers[int(rng.choice(len(makers), p=odds))](rng, footing)
    return tuple(Clipped(solid, 0.0, seat.height) for solid in solids)


def _arms(rng: np.random.Generator, kind: str, seat: _Seat, lean: float, is_heavy: bool) -> tuple[Solid, ...]:
    if kind == "none":
        return ()
    rise = rng.uniform(0.15, 0.24)
    rear = -seat.half_z - np.tan(lean) * (rise + seat.half_thickness) + 0.03  # where the back is at that height
    front = seat.half_z * rng.uniform(0.5, 0.92)
    flare, r = rng.uniform(0.0, 0.035), rng.uniform(0.013, 0.02)
    thickness = rng.uniform(0.04, 0.075) if is_heavy else rng.uniform(0.014, 0.025)
    slope, reach = rng.uniform(-0.02, 0.03), rng.uniform(0.3, 0.95)
    solids: list[Solid] = []
    for side in (-1, 1):
        if kind == "panel":
            solids.append(_panel_arm(side, seat, rise, front, rear, thickness))
        elif kind == "rest":
            solids += _rest_arm(side, seat, rise, front, rear, flare, (1.4 * r, slope, reach))
        elif kind == "tube":
            solids.append(_tube_arm(side, seat, rise, front, rear, flare, r))
        else:
            solids += _arch_arm(side, seat, rise, front, flare, r)
    return tuple(solids)


def _panel_arm(side: int, seat: _Seat, rise: float, front: float, rear: float, thickness: float) -> Solid:
    """A board or bolster from below the seat's edge up to the height of the arm."""
    low, high = seat.height - seat.half_thickness, seat.top + rise
    box = Box((thickness, (high - low) / 2, (front - rear) / 2), 0.8 * thickness)
    return place(box, (side * (seat.half_x + 0.4 * thickness), (high + low) / 2, (front + rear) / 2))


def _rest_arm(
    side: int, seat: _Seat, rise: float, front: float, rear: float, flare: float, form: tuple[float, float, float]
) -> list[Solid]:
    """A rest that ends in the back, on a post. form : half width, rise to the rear, the post's place."""
    half_width, slope, reach = form
    x, y = seat.half_x, seat.top + rise
    rest = beam((side * (x + flare), y, front), (side * (0.92 * x), y + slope, rear), half_width, 0.014, 0.01)
    post_z = front * reach
    foot = (side * 0.88 * x, seat.height, 0.85 * post_z)
    return [rest, Rod(foot, (side * (x + 0.8 * flare), y, post_z), 0.7 * half_width, 0.7 * half_width)]


def _tube_arm(side: int, seat: _Seat, rise: float, front: float, rear: float, flare: float, r: float) -> Solid:
    """A bent bar from the seat's side up, forward and back into the chair's back."""
    x, y = side * (seat.half_x + flare), seat.top + rise
    knots = (
        (side * 0.88 * seat.half_x, seat.height, 0.5 * front),
        (x, seat.top + 0.55 * rise, front),
        (x, y, 0.6 * front),
        (side * 0.92 * seat.half_x, y, rear),
    )
    return Tube(tuple((p[0], p[1], p[2]) for p in smooth_curve(knots, 14)), (r,) * 14)


def _arch_arm(side: int, seat: _Seat, rise: float, front: float, flare: float, r: float) -> list[Solid]:
    """A bar that leaves the seat and comes back to it further behind, padded on top."""
    x, y, rear = side * (seat.half_x + 0.5 * flare + 0.012), seat.top + rise, -0.55 * seat.half_z
    inside = side * 0.86 * seat.half_x
    path = (
        (inside, seat.height, 0.8 * front),
        (x, seat.top, 0.85 * front),
        (x, y - 0.02, 0.95 * front),
        (x, y, 0.8 * front),
        (x, y, rear),
        (x, y - 0.03, rear - 0.03),
        (x, seat.top, rear),
        (inside, seat.height, rear),
    )
    pad = Box((1.6 * r, 0.015, (0.9 * front - rear) / 2), 0.01)
    return [Tube(path, (r,) * len(path)), place(pad, (x, y + 0.4 * r, (0.9 * front + rear) / 2))]
