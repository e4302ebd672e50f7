"""Solids swept from a 2D profile: extruded outlines, turned (lathe) bodies, curved panels, wings."""

import itertools
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from jaxtyping import Float

from partwise.simulate.primitives import Distances, Points, Vector

Outline: TypeAlias = tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Extrusion:
    """A polygon in the xz plane, extended to y = ±half_height; `rounding` rounds all edges inwards."""

    outline: Outline
    half_height: float
    rounding: float = 0.0

    @property
    def centre(self) -> Vector:
        low, high = np.min(self.outline, axis=0), np.max(self.outline, axis=0)
        return (float(low[0] + high[0]) / 2.0, 0.0, float(low[1] + high[1]) / 2.0)

    @property
    def radius(self) -> float:
        corners = np.array(self.outline) - np.array([self.centre[0], self.centre[2]])
        return float(np.hypot(np.linalg.norm(corners, axis=1).max(), self.half_height))

    @property
    def thickness(self) -> float:
        return 2.0 * self.half_height

    def distance(self, points: Points) -> Distances:
        rounding = min(self.rounding, self.half_height)
        side = polygon_distance(points[:, [0, 2]], np.array(self.outline)) + rounding
        flat = np.abs(points[:, 1]) - self.half_height + rounding
        outside = np.hypot(np.maximum(side, 0.0), np.maximum(flat, 0.0))
        return outside + np.minimum(np.maximum(side, flat), 0.0) - rounding


@dataclass(frozen=True, slots=True)
class Lathe:
    """A profile of (radius, height) pairs, bottom to top, turned about the y axis and closed by flat ends: solid."""

    profile: Outline

    @property
    def centre(self) -> Vector:
        return (0.0, (self.profile[0][1] + self.profile[-1][1]) / 2.0, 0.0)

    @property
    def radius(self) -> float:
        return float(max(np.hypot(r, y - self.centre[1]) for r, y in self.profile))

    @property
    def thickness(self) -> float:
        return 2.0 * min(max(r, 0.02) for r, _ in self.profile)

    def distance(self, points: Points) -> Distances:
        flat = np.stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]], axis=1)
        ends = np.array([[0.0, self.profile[0][1]], [0.0, self.profile[-1][1]]])
        # The axis closes the polygon, but it is no part of the surface.
        return polygon_distance(flat, np.concatenate([ends[:1], np.array(self.profile), ends[1:]]), is_closed=False)


@dataclass(frozen=True, slots=True)
class LatheShell:
    """The line of a (radius, height) profile turned about the y axis and given a wall: bowls, cups, lamp shades."""

    profile: Outline
    wall: float

    @property
    def centre(self) -> Vector:
        heights = [y for _, y in self.profile]
        return (0.0, (min(heights) + max(heights)) / 2.0, 0.0)

    @property
    def radius(self) -> float:
        return float(max(np.hypot(r, y - self.centre[1]) for r, y in self.profile)) + self.wall / 2.0

    @property
    def thickness(self) -> float:
        return self.wall

    def distance(self, points: Points) -> Distances:
        r, y = np.hypot(points[:, 0], points[:, 2]), points[:, 1].copy()
        profile = np.array(self.profile)
        squared = np.full(len(points), np.inf)
        for k in range(len(profile) - 1):
            np.minimum(squared, _squared_to_edge(r, y, profile[k], profile[k + 1]), out=squared)
        return np.sqrt(squared) - self.wall / 2.0


@dataclass(frozen=True, slots=True)
class CurvedPanel:
    """A board bent about the y axis: its middle lies at the origin, its ends come forward (+z).

    `bend_radius` is that of the middle surface; `half_width` is measured along the arc.
    """

    bend_radius: float
    half_width: float
    half_height: float
    half_depth: float
    rounding: float = 0.0

    @property
    def centre(self) -> Vector:
        return (0.0, 0.0, self.bend_radius * (1.0 - np.cos(self._half_angle)) / 2.0)

    @property
    def radius(self) -> float:
        sag = self.bend_radius * (1.0 - np.cos(self._half_angle)) / 2.0
        reach = self.bend_radius * np.sin(min(self._half_angle, np.pi / 2))
        return float(np.linalg.norm([reach, self.half_height, sag])) + self.half_depth

    @property
    def thickness(self) -> float:
        return 2.0 * self.half_depth

    @property
    def _half_angle(self) -> float:
        return min(self.half_width / self.bend_radius, np.pi)

    def distance(self, points: Points) -> Distances:
        forward = self.bend_radius - points[:, 2]
        reach = np.hypot(points[:, 0], forward)
        rounding = min(self.rounding, self.half_depth)
        beyond = np.abs(np.arctan2(points[:, 0], forward)) - (self._half_angle - rounding / self.bend_radius)
        # Past the ends distances are straight, in the frame of the nearer end.
        is_past = beyond > 0.0
        across = np.where(is_past, reach * np.sin(beyond), self.bend_radius * beyond)
        depth = np.abs(np.where(is_past, reach * np.cos(beyond), reach) - self.bend_radius) - self.half_depth + rounding
        height = np.abs(points[:, 1]) - self.half_height + rounding
        q = np.stack([across, height, depth], axis=1)
        return np.sqrt((np.maximum(q, 0.0) ** 2).sum(axis=1)) + np.minimum(q.max(axis=1), 0.0) - rounding


@dataclass(frozen=True, slots=True)
class Wing:
    """A half wing that starts at the origin and runs along +x; its leading edge looks to +z.

    span : length along x. root_chord, tip_chord : depth along z. sweep : how far the tip's leading edge lies behind the
    root's. dihedral : rise of the tip. thickness_ratio : thickness over chord. edge : radius of the trailing edge and
    of the tip, which keeps the wing thick enough for a grid.

    Differs from an exact distance: points are measured at their own section.
    """

    span: float
    root_chord: float
    tip_chord: float
    sweep: float
    dihedral: float
    thickness_ratio: float
    edge: float

    @property
    def centre(self) -> Vector:
        return (self.span / 2.0, self.dihedral / 2.0, -(self.sweep + max(self.root_chord, self.tip_chord)) / 2.0)

    @property
    def radius(self) -> float:
        depth = abs(self.sweep) + max(self.root_chord, self.tip_chord)
        return float(np.linalg.norm([self.span, self.dihedral, depth])) / 2.0 + depth * self.thickness_ratio

    @property
    def thickness(self) -> float:
        return 2.0 * self.edge

    def distance(self, points: Points) -> Distances:
        x, y, z = points.T
        s = np.clip(x / self.span, 0.0, 1.0)
        chord = self.root_chord + s * (self.tip_chord - self.root_chord)
        u = (-z - s * self.sweep) / chord  # 0 at the leading edge, 1 at the trailing edge
        inside_u = np.clip(u, 0.0, 1.0)
        half = self.thickness_ratio * chord * 2.6 * inside_u * (1.0 - inside_u) * (1.3 - 0.9 * inside_u)
        rise = np.abs(y - s * self.dihedral) - half
        slant = 1.0 / np.sqrt(1.0 + (self.sweep / self.span) ** 2)
        behind = np.maximum(-u, u - 1.0) * chord * slant
        beyond = np.maximum(-x, x - self.span)
        q = np.maximum(np.stack([rise, behind, beyond], axis=1), 0.0)
        inner = np.minimum(np.maximum(np.maximum(rise, behind), beyond), 0.0)
        return np.sqrt((q**2).sum(axis=1)) + inner - self.edge


def polygon_distance(
    points: Float[np.ndarray, "n 2"], outline: Float[np.ndarray, "k 2"], *, is_closed: bool = True
) -> Distances:
    """Signed distance to a simple polygon, (n,) float64, negative inside; either winding.

    Unless `is_closed`, the edge from the last corner to the first is no surface; it must lie left of all points.

    Source: Quilez, "2D polygon", exact.
    """
    squared = np.full(len(points), np.inf)
    inside = np.zeros(len(points), dtype=bool)
    x, y = points[:, 0].copy(), points[:, 1].copy()
    corners = np.concatenate([outline, outline[:1]]) if is_closed else outline
    for a, b in itertools.pairwise(corners):
        np.minimum(squared, _squared_to_edge(x, y, a, b), out=squared)
        if a[1] != b[1]:
            x_at = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            inside ^= ((y >= a[1]) != (y >= b[1])) & (x < x_at)
    distance = np.sqrt(squared)
    return np.where(inside, -distance, distance)


def superellipse(half_x: float, half_z: float, power: float, n_points: int = 28) -> Outline:
    """Outline |x/half_x|^power + |z/half_z|^power = 1: 2 is an ellipse, 4 and more a rounded rectangle."""
    t = np.linspace(0.0, 2.0 * np.pi, n_points, endpoint=False)
    x = half_x * np.sign(np.cos(t)) * np.abs(np.cos(t)) ** (2.0 / power)
    z = half_z * np.sign(np.sin(t)) * np.abs(np.sin(t)) ** (2.0 / power)
    return tuple((float(a), float(b)) for a, b in zip(x, z, strict=True))


def smooth_curve(knots: tuple[tuple[float, ...], ...], n_points: int) -> tuple[tuple[float, ...], ...]:
    """Catmull–Rom curve through the knots (any dimension), sampled evenly in parameter, ends included."""
    through = np.array(knots)
    padded = np.concatenate([[2 * through[0] - through[1]], through, [2 * through[-1] - through[-2]]])
    position = np.linspace(0.0, len(through) - 1.0, n_points)
    k = np.minimum(position.astype(int), len(through) - 2)
    t = (position - k)[:, None]
    before, a, b, after = (padded[k + j] for j in range(4))
    curve = a + t / 2 * (b - before + t * (2 * before - 5 * a + 4 * b - after + t * (3 * (a - b) + after - before)))
    return tuple(tuple(float(v) for v in row) for row in curve)


def _squared_to_edge(x: np.ndarray, y: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    # Coordinates apart, as contiguous arrays: three times as fast as rows of pairs, and this is where the time goes.
    (ax, ay), (ex, ey) = a, b - a
    dx, dy = x - ax, y - ay
    t = np.clip((dx * ex + dy * ey) / max(float(ex * ex + ey * ey), 1e-18), 0.0, 1.0)
    dx -= t * ex
    dy -= t * ey
    return dx * dx + dy * dy
