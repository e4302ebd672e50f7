"""Chair backs of many kinds, upright at the origin: from y = 0 (inside the seat) up, across ±half_x, depth along z."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from partwise.simulate.primitives import Box, Rod, Solid, Tube, place
from partwise.simulate.supports import beam
from partwise.simulate.sweeps import CurvedPanel, Extrusion, smooth_curve, superellipse

Back: TypeAlias = Callable[[np.random.Generator, float, float], tuple[Solid, ...]]


def random_back(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """Any kind of back."""
    kinds: tuple[Back, ...] = (random_wide_back, _shaped, _floating, _barrel)
    return kinds[int(rng.choice(4, p=[0.62, 0.16, 0.14, 0.08]))](rng, half_x, height)


def random_wide_back(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A back that spans the seat's width at the height of arms."""
    kinds: tuple[Back, ...] = (_board, _curved, _slatted, _ladder, _spindles, _crossed, upholstered_back)
    odds = [0.17, 0.17, 0.19, 0.19, 0.14, 0.09, 0.05]
    return kinds[int(rng.choice(len(kinds), p=odds))](rng, half_x, height)


def _board(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    t = rng.uniform(0.013, 0.03)
    return (place(Box((half_x, height / 2, t), rng.uniform(0.2, 0.9) * t), (0.0, height / 2, 0.0)),)


def _shaped(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A board with a round or shield-like outline."""
    t = rng.uniform(0.013, 0.03)
    if rng.random() < 0.5:
        outline = superellipse(half_x, 0.55 * height, rng.uniform(2.0, 3.5))
    else:
        waist = rng.uniform(0.45, 0.9)
        knots = ((waist, 0.5), (waist, 0.3), (1.0, -0.2), (0.9, -0.42), (0.45, -0.54), (0.0, -0.56))
        right = [(x * half_x, y * height) for x, y in smooth_curve(knots, 12)]
        outline = (*right, *((-x, y) for x, y in right[-2::-1]))
    # The outline's +z becomes down, so it was drawn upside down.
    return (place(Extrusion(outline, t, 0.8 * t), (0.0, height / 2, 0.0), pitch=np.pi / 2),)


def _curved(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A board bent a little around the sitter."""
    bend, t = half_x * rng.uniform(1.5, 3.0), rng.uniform(0.014, 0.03)
    return (place(CurvedPanel(bend, 1.05 * half_x, height / 2, t, 0.9 * t), (0.0, height / 2, -0.01)),)


def _barrel(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A low board that wraps far around the sitter."""
    bend, t = half_x * rng.uniform(1.0, 1.15), rng.uniform(0.016, 0.035)
    tall = height * rng.uniform(0.6, 0.85)
    return (place(CurvedPanel(bend, half_x * rng.uniform(1.35, 1.6), tall / 2, t, 0.9 * t), (0.0, tall / 2, -0.01)),)


def _slatted(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """Posts and a top rail around upright slats."""
    posts = _posts(rng, half_x, height)
    t = rng.uniform(0.011, 0.015)
    n_slats = int(rng.integers(2, 6))
    low = rng.uniform(0.0, 0.25) * height
    width = rng.uniform(0.25, 0.45) * 2.0 * half_x / (n_slats + 1) / 1.6
    slats: list[Solid] = [
        place(Box((max(width, 0.012), (height - low) / 2, t), 0.003), (x, (height + low) / 2, 0.0))
        for x in np.linspace(-half_x, half_x, n_slats + 2)[1:-1]
    ]
    rail = rng.uniform(0.02, 0.055)
    slats.append(place(Box((half_x, rail, 1.3 * t), 0.008), (0.0, height - 0.4 * rail, 0.0)))
    if low > 0.03:
        slats.append(place(Box((half_x, 0.02, t), 0.004), (0.0, low, 0.0)))
    return (*posts, *slats)


def _ladder(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """Posts and two to five boards across, flat or bent backwards."""
    n_rungs = int(rng.integers(2, 6))
    t = rng.uniform(0.011, 0.016)
    pitch = 0.8 * height / n_rungs
    tall = pitch * rng.uniform(0.22, 0.36)
    is_bent = rng.random() < 0.5
    rungs: list[Solid] = []
    for k in range(n_rungs):
        y = height - 0.03 - k * pitch
        if is_bent:
            rungs.append(place(CurvedPanel(2.2 * half_x, half_x, tall, t, 0.6 * t), (0.0, y, -0.25 * half_x)))
        else:
            rungs.append(place(Box((half_x, tall, t), 0.6 * t), (0.0, y, 0.0)))
    return (*_posts(rng, half_x, height), *rungs)


def _spindles(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A bow of bent wood over thin sticks."""
    r = rng.uniform(0.013, 0.019)
    flat = rng.uniform(0.5, 1.0)
    knots = ((-0.85, 0.0), (-1.0, 0.55), (-0.75 * flat - 0.1, 0.92), (0.0, 1.0))
    left = smooth_curve(tuple((x * half_x, y * height, 0.0) for x, y in knots), 10)
    path = (*left, *((-x, y, z) for x, y, z in left[-2::-1]))
    bow = Tube(tuple((p[0], p[1], p[2]) for p in path), (r,) * len(path))
    heights = np.array([p[:2] for p in path])
    sticks: list[Solid] = []
    for x in np.linspace(-0.62, 0.62, int(rng.integers(4, 8))) * half_x:
        top = float(np.interp(x, heights[2:-2, 0], heights[2:-2, 1]))
        sticks.append(Rod((0.85 * x, 0.0, 0.0), (float(x), top, 0.0), 0.011, 0.011))
    return (bow, *sticks)


def _crossed(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A frame around an X."""
    low, t = rng.uniform(0.12, 0.3) * height, 0.013
    rails: list[Solid] = [place(Box((half_x, 0.022, t), 0.005), (0.0, y, 0.0)) for y in (low, height - 0.02)]
    x = half_x - 0.015
    diagonals = [beam((-s * x, low, 0.0), (s * x, height - 0.02, 0.0), t, 0.016, 0.004) for s in (-1.0, 1.0)]
    return (*_posts(rng, half_x, height), *rails, *diagonals)


def _floating(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A pad held above the seat by one broad or two thin uprights."""
    tall = height * rng.uniform(0.25, 0.42)
    t = rng.uniform(0.016, 0.03)
    bend = rng.uniform(1.4, 4.0) * half_x
    pad = place(CurvedPanel(bend, half_x, tall, t, 0.9 * t), (0.0, height - tall, -0.01))
    if rng.random() < 0.35:
        width = rng.uniform(0.03, 0.06)
        return (pad, place(Box((width, (height - tall) / 2, 0.014), 0.008), (0.0, (height - tall) / 2, -0.012)))
    r, x = rng.uniform(0.013, 0.018), half_x * rng.uniform(0.5, 0.85)
    return (pad, *(Rod((s * x, 0.0, 0.0), (s * x, height - tall, 0.0), r, r) for s in (-1.0, 1.0)))


def upholstered_back(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """A thick soft board, some with wings beside the head."""
    t = rng.uniform(0.04, 0.075)
    board: Solid = place(Box((half_x, height / 2, t), rng.uniform(0.5, 0.95) * t), (0.0, height / 2, 0.0))
    if rng.random() < 0.65:
        return (board,)
    wings = [
        place(Box((0.025, 0.24 * height, 0.09), 0.02), (s * half_x, 0.74 * height, 0.08), yaw=s * -0.2)
        for s in (-1.0, 1.0)
    ]
    return (board, *wings)


def _posts(rng: np.random.Generator, half_x: float, height: float) -> tuple[Solid, ...]:
    """The two uprights of a frame, square or round, some rising above it."""
    r = rng.uniform(0.013, 0.022)
    top = height + rng.choice([0.0, 1.0]) * rng.uniform(0.01, 0.05)
    x = half_x - r
    if rng.random() < 0.5:
        return tuple(place(Box((r, top / 2, r), 0.3 * r), (s * x, top / 2, 0.0)) for s in (-1.0, 1.0))
    return tuple(Rod((s * x, 0.0, 0.0), (s * x, top, 0.0), r, 0.85 * r) for s in (-1.0, 1.0))
