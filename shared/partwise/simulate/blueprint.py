"""What a simulated shape is made of: solids with part names, how they melt into each other, and how they are bent.

A `Blueprint` answers two questions about any point: how far the surface is, and which piece it belongs to.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.simulate.primitives import Distances, Points, Solid, Vector, smooth_difference, smooth_union


@dataclass(frozen=True, slots=True)
class Piece:
    """A solid and the part of the shape that it belongs to."""

    solid: Solid
    part: str


@dataclass(frozen=True, slots=True)
class Ripples:
    """Low waves that displace points: wave vectors (radians per unit), amplitudes (model units), phases (radians)."""

    wave_vectors: tuple[Vector, ...] = ()
    amplitudes: tuple[Vector, ...] = ()
    phases: tuple[float, ...] = ()

    def displacement(self, points: Points) -> Points:
        """How far each point is moved, (n, 3) float64."""
        moved = np.zeros_like(points)
        for wave, amplitude, phase in zip(self.wave_vectors, self.amplitudes, self.phases, strict=True):
            moved += np.sin(points @ np.array(wave) + phase)[:, None] * np.array(amplitude)
        return moved


@dataclass(frozen=True, slots=True)
class Deformation:
    """A gentle bending of space, so that nothing is quite straight. All zero (the default): none.

    taper : relative widening of x and z per unit of height. twist : radians per unit of height.
    lean : z per unit of height. bow : z per unit of x². pivot : height at which taper, twist and lean do nothing.
    """

    taper: float = 0.0
    twist: float = 0.0
    lean: float = 0.0
    bow: float = 0.0
    pivot: float = 0.0
    ripples: Ripples = Ripples()

    def to_straight(self, points: Points) -> Points:
        """Where points of the deformed shape lie in the straight one."""
        x, y, z = points.T
        height = y - self.pivot
        scale = 1.0 / (1.0 + np.clip(self.taper * height, -0.5, 1.0))
        cosine, sine = np.cos(self.twist * height), np.sin(self.twist * height)
        z = z - self.lean * height - self.bow * x**2
        straight = np.stack([scale * (cosine * x - sine * z), y, scale * (sine * x + cosine * z)], axis=1)
        return straight + self.ripples.displacement(points)


def random_ripples(rng: np.random.Generator, amplitude: float, n_waves: int = 3) -> Ripples:
    """Waves one to three units long whose displacements together are about `amplitude` (model units)."""
    waves = rng.normal(size=(n_waves, 3))
    waves *= rng.uniform(2.0, 7.0, size=(n_waves, 1)) / np.linalg.norm(waves, axis=1, keepdims=True)
    amplitudes = rng.normal(size=(n_waves, 3)) * amplitude / np.sqrt(3.0 * n_waves)
    return Ripples(_vectors(waves), _vectors(amplitudes), tuple(rng.uniform(0.0, 2.0 * np.pi, n_waves).tolist()))


@dataclass(frozen=True, slots=True)
class Blueprint:
    """A shape to be contoured; y is up, +z is front.

    pieces : what is there. blend : width of the seams between pieces, model units. carvings : what is taken away again.
    wall : the thinnest that carvings leave of any piece, model units.
    """

    pieces: tuple[Piece, ...]
    blend: float
    deformation: Deformation = Deformation()
    carvings: tuple[Solid, ...] = ()
    wall: float = np.inf

    @property
    def thickness(self) -> float:
        """Narrowest width of any piece, model units."""
        return min(self.piece_thickness(index) for index in range(len(self.pieces)))

    def piece_thickness(self, index: int) -> float:
        """Narrowest width of one piece, model units."""
        return min(self.pieces[index].solid.thickness, self.wall)

    def distance(self, points: Points) -> Distances:
        """Field of the whole shape, (n,) float64, negative inside."""
        straight = self.deformation.to_straight(points)
        total = np.full(len(points), np.inf)
        for piece in self.pieces:
            # Far from a piece the field cannot change: skip those points.
            near = np.flatnonzero(_sphere_distance(piece.solid, straight) < total + self.blend)
            total[near] = smooth_union(total[near], piece.solid.distance(straight[near]), self.blend)
        return self._carve(total, straight)

    def piece_distance(self, index: int, points: Points) -> Distances:
        """Field of one piece alone, carved, (n,) float64."""
        straight = self.deformation.to_straight(points)
        return self._carve(self.pieces[index].solid.distance(straight), straight)

    def nearest_piece(self, points: Points) -> Int[np.ndarray, " n"]:
        """Index of the piece whose surface is nearest (or in which the point lies deepest), (n,) int64."""
        straight = self.deformation.to_straight(points)
        best = np.full(len(points), np.inf)
        nearest = np.zeros(len(points), dtype=np.int64)
        for index, piece in enumerate(self.pieces):
            near = np.flatnonzero(_sphere_distance(piece.solid, straight) < best)
            distance = piece.solid.distance(straight[near])
            closer = distance < best[near]
            best[near[closer]] = distance[closer]
            nearest[near[closer]] = index
        return nearest

    def bounds(self) -> Float[np.ndarray, "2 3"]:
        """Loose axis-aligned box (low, high) that holds the deformed shape, model units."""
        return _roomy(np.array([_sphere_box(piece.solid) for piece in self.pieces]))

    def piece_bounds(self, index: int) -> Float[np.ndarray, "2 3"]:
        """Loose box around one deformed piece, model units."""
        whole = self.bounds()
        low, high = _sphere_box(self.pieces[index].solid)
        room = 0.1 * (whole[1] - whole[0])
        return np.array([low - room, high + room])

    def _carve(self, distance: Distances, straight: Points) -> Distances:
        for solid in self.carvings:
            distance = smooth_difference(distance, solid.distance(straight), self.blend)
        return distance


def _sphere_distance(solid: Solid, points: Points) -> Distances:
    return np.sqrt(((points - np.array(solid.centre)) ** 2).sum(axis=1)) - solid.radius


def _sphere_box(solid: Solid) -> np.ndarray:
    centre = np.array(solid.centre)
    return np.array([centre - solid.radius, centre + solid.radius])


def _roomy(boxes: np.ndarray) -> np.ndarray:
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    room = 0.12 * (high - low).max()
    return np.array([low - room, high + room])


def _vectors(rows: np.ndarray) -> tuple[Vector, ...]:
    return tuple((float(x), float(y), float(z)) for x, y, z in rows)
