"""Signed distances of simple solids: negative inside, positive outside, in model units.

A `Solid` answers for many points at once. Solids with an analytic field live here, those swept from a 2D profile in
`partwise.simulate.sweeps`. Fields may fall somewhat short of the true distance, never by far beyond it: the contouring
allows for that (see `partwise.simulate.contour`).
"""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from jaxtyping import Float

Points: TypeAlias = Float[np.ndarray, "n 3"]
Distances: TypeAlias = Float[np.ndarray, " n"]
Vector: TypeAlias = tuple[float, float, float]


class Solid(Protocol):
    """A shape in space: its field, a sphere that holds it, and how thin it gets."""

    @property
    def centre(self) -> Vector: ...

    @property
    def radius(self) -> float:
        """Of a sphere about `centre` that holds the solid."""
        ...

    @property
    def thickness(self) -> float:
        """Narrowest full width: what a grid must resolve."""
        ...

    def distance(self, points: Points) -> Distances: ...


@dataclass(frozen=True, slots=True)
class Box:
    """Centred at the origin; `rounding` rounds edges inwards, so the half extents are the outermost."""

    half_extents: Vector
    rounding: float = 0.0

    @property
    def centre(self) -> Vector:
        return (0.0, 0.0, 0.0)

    @property
    def radius(self) -> float:
        return float(np.linalg.norm(self.half_extents))

    @property
    def thickness(self) -> float:
        return 2.0 * min(self.half_extents)

    def distance(self, points: Points) -> Distances:
        rounding = min(self.rounding, min(self.half_extents))
        q = np.abs(points) - (np.array(self.half_extents) - rounding)
        outside = np.sqrt((np.maximum(q, 0.0) ** 2).sum(axis=1))
        return outside + np.minimum(q.max(axis=1), 0.0) - rounding


@dataclass(frozen=True, slots=True)
class Ellipsoid:
    """Centred at the origin.

    Source: Quilez, "distance to an ellipsoid" (bound, exact on the surface). Differs: the centre, where it is 0/0, gets
    the smallest radius.
    """

    radii: Vector

    @property
    def centre(self) -> Vector:
        return (0.0, 0.0, 0.0)

    @property
    def radius(self) -> float:
        return max(self.radii)

    @property
    def thickness(self) -> float:
        return 2.0 * min(self.radii)

    def distance(self, points: Points) -> Distances:
        radii = np.array(self.radii)
        k0 = np.linalg.norm(points / radii, axis=1)
        k1 = np.linalg.norm(points / radii**2, axis=1)
        return np.where(k1 > 1e-9, k0 * (k0 - 1.0) / np.maximum(k1, 1e-9), -min(self.radii))


@dataclass(frozen=True, slots=True)
class Rod:
    """Round-ended bar from `start` to `end` whose radius runs linearly between the two."""

    start: Vector
    end: Vector
    start_radius: float
    end_radius: float

    @property
    def centre(self) -> Vector:
        return _midpoint(self.start, self.end)

    @property
    def radius(self) -> float:
        half = float(np.linalg.norm(np.subtract(self.end, self.start))) / 2.0
        return half + max(self.start_radius, self.end_radius)

    @property
    def thickness(self) -> float:
        return 2.0 * min(self.start_radius, self.end_radius)

    def distance(self, points: Points) -> Distances:
        gap, t = segment_distance(points, np.array(self.start), np.array(self.end))
        return gap - (self.start_radius + t * (self.end_radius - self.start_radius))


@dataclass(frozen=True, slots=True)
class Tube:
    """Round bar along a polyline, its radius linear between the given ones. Source of curved legs, handles, rims."""

    path: tuple[Vector, ...]
    radii: tuple[float, ...]

    @property
    def centre(self) -> Vector:
        low, high = np.min(self.path, axis=0), np.max(self.path, axis=0)
        return _midpoint(tuple(low), tuple(high))

    @property
    def radius(self) -> float:
        return float(np.linalg.norm(np.subtract(self.path, self.centre), axis=1).max()) + max(self.radii)

    @property
    def thickness(self) -> float:
        return 2.0 * min(self.radii)

    def distance(self, points: Points) -> Distances:
        nearest = np.full(len(points), np.inf)
        path = np.array(self.path)
        for k in range(len(path) - 1):
            gap, t = segment_distance(points, path[k], path[k + 1])
            np.minimum(nearest, gap - (self.radii[k] + t * (self.radii[k + 1] - self.radii[k])), out=nearest)
        return nearest


@dataclass(frozen=True, slots=True)
class Frustum:
    """Cone cut flat at y = ±half_height, with the given radii below and above; `rounding` rounds its rims inwards.

    Source: Quilez, "capped cone", exact.
    """

    half_height: float
    bottom_radius: float
    top_radius: float
    rounding: float = 0.0

    @property
    def centre(self) -> Vector:
        return (0.0, 0.0, 0.0)

    @property
    def radius(self) -> float:
        return float(np.hypot(self.half_height, max(self.bottom_radius, self.top_radius)))

    @property
    def thickness(self) -> float:
        return 2.0 * min(self.half_height, self.bottom_radius, self.top_radius)

    def distance(self, points: Points) -> Distances:
        rounding = min(self.rounding, 0.9 * self.thickness / 2.0)
        h, low, high = (v - rounding for v in (self.half_height, self.bottom_radius, self.top_radius))
        r, y = np.hypot(points[:, 0], points[:, 2]), points[:, 1]
        cap_x = r - np.minimum(r, np.where(y < 0.0, low, high))
        cap_y = np.abs(y) - h
        slope_x, slope_y = high - low, 2.0 * h
        t = np.clip(((high - r) * slope_x + (h - y) * slope_y) / (slope_x**2 + slope_y**2), 0.0, 1.0)
        side_x, side_y = r - high + slope_x * t, y - h + slope_y * t
        inside = (side_x < 0.0) & (cap_y < 0.0)
        nearest = np.sqrt(np.minimum(cap_x**2 + cap_y**2, side_x**2 + side_y**2))
        return np.where(inside, -nearest, nearest) - rounding


@dataclass(frozen=True, slots=True)
class TorusArc:
    """Part of a torus in the xy plane about the origin, opening by ±half_angle (radians) about +x, round-ended.

    Source: Quilez, "capped torus", exact.
    """

    ring_radius: float
    tube_radius: float
    half_angle: float

    @property
    def centre(self) -> Vector:
        return (0.0, 0.0, 0.0)

    @property
    def radius(self) -> float:
        return self.ring_radius + self.tube_radius

    @property
    def thickness(self) -> float:
        return 2.0 * self.tube_radius

    def distance(self, points: Points) -> Distances:
        x, y = points[:, 0], np.abs(points[:, 1])
        sine, cosine = np.sin(self.half_angle), np.cos(self.half_angle)
        in_arc = cosine * y <= sine * x
        along = np.where(in_arc, np.hypot(x, y), cosine * x + sine * y)
        squared = (points**2).sum(axis=1) + self.ring_radius**2 - 2.0 * self.ring_radius * along
        return np.sqrt(np.maximum(squared, 0.0)) - self.tube_radius


@dataclass(frozen=True, slots=True)
class Placed:
    """A solid turned by `rotation` (rows of a proper rotation matrix) and then moved by `offset`."""

    solid: Solid
    rotation: tuple[Vector, Vector, Vector]
    offset: Vector

    @property
    def centre(self) -> Vector:
        x, y, z = np.array(self.rotation) @ np.array(self.solid.centre) + np.array(self.offset)
        return (float(x), float(y), float(z))

    @property
    def radius(self) -> float:
        return self.solid.radius

    @property
    def thickness(self) -> float:
        return self.solid.thickness

    def distance(self, points: Points) -> Distances:
        return self.solid.distance((points - np.array(self.offset)) @ np.array(self.rotation))


@dataclass(frozen=True, slots=True)
class Clipped:
    """What of a solid lies between y = low and y = high: feet stand flat, tops do not come through."""

    solid: Solid
    low: float
    high: float

    @property
    def centre(self) -> Vector:
        return self.solid.centre

    @property
    def radius(self) -> float:
        return self.solid.radius

    @property
    def thickness(self) -> float:
        return min(self.solid.thickness, self.high - self.low)

    def distance(self, points: Points) -> Distances:
        y = points[:, 1]
        return np.maximum(self.solid.distance(points), np.maximum(self.low - y, y - self.high))


@dataclass(frozen=True, slots=True)
class Mirrored:
    """A solid reflected in the plane x = 0."""

    solid: Solid

    @property
    def centre(self) -> Vector:
        x, y, z = self.solid.centre
        return (-x, y, z)

    @property
    def radius(self) -> float:
        return self.solid.radius

    @property
    def thickness(self) -> float:
        return self.solid.thickness

    def distance(self, points: Points) -> Distances:
        return self.solid.distance(points * np.array([-1.0, 1.0, 1.0]))


def place(solid: Solid, offset: Vector, *, pitch: float = 0.0, yaw: float = 0.0, roll: float = 0.0) -> Placed:
    """`solid` turned about z (roll), then x (pitch), then y (yaw), all in radians, then moved by `offset`."""
    (cx, sx), (cy, sy), (cz, sz) = ((np.cos(a), np.sin(a)) for a in (pitch, yaw, roll))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    rows = (about_y @ about_x @ about_z).tolist()
    return Placed(solid, (tuple(rows[0]), tuple(rows[1]), tuple(rows[2])), offset)


def segment_distance(points: Points, start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each point to the segment, and where along it (0 at start, 1 at end) the nearest point lies."""
    axis = end - start
    t = np.clip((points - start) @ axis / max(float(axis @ axis), 1e-18), 0.0, 1.0)
    return np.linalg.norm(points - start - t[:, None] * axis, axis=1), t


def smooth_difference(a: Distances, b: Distances, blend: float) -> Distances:
    """What of a is not in b, its new rim rounded over about `blend` units."""
    return -smooth_union(-a, b, blend)


def smooth_union(a: Distances, b: Distances, blend: float) -> Distances:
    """Union of two fields whose seam is rounded over about `blend` units; the plain minimum farther away.

    Source: Quilez, quadratic polynomial smooth minimum.
    """
    if blend <= 0.0:
        return np.minimum(a, b)
    overlap = np.maximum(blend - np.abs(a - b), 0.0) / blend
    return np.minimum(a, b) - overlap**2 * blend / 4.0


def _midpoint(a: Vector, b: Vector) -> Vector:
    return (float(a[0] + b[0]) / 2.0, float(a[1] + b[1]) / 2.0, float(a[2] + b[2]) / 2.0)
