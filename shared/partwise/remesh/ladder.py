"""`remesh`: attempts in order until one is accepted, then the levels; everything that was tried is recorded.

`Ladder` offers the same one attempt at a time, for callers that supervise each: attempts run native code, which may
hang, crash or swallow memory. Key types: `Attempt`, `Level`, `RemeshResult`.
"""

import time
from dataclasses import asdict, dataclass

from partwise.errors import ConflictError, DegenerateMeshError, MeshError, ParameterError
from partwise.features.light_field import light_field
from partwise.mesh import TriMesh
from partwise.remesh.accept_as_is import defects_of, why_not_as_is
from partwise.remesh.acceptance import judge
from partwise.remesh.alpha_wrap import alpha_wrap, fitted_wrap
from partwise.remesh.components import largest_outer_component
from partwise.remesh.decimate import decimate
from partwise.remesh.implicit_contour import implicit_contour
from partwise.remesh.parameters import AlphaWrap, AttemptParameters, RemeshParameters
from partwise.render.views import DepthRenderer


@dataclass(frozen=True, slots=True)
class Attempt:
    """One try at a closed surface; plain values only, so that it can be stored as it is.

    method : "as is", "alpha wrap" or "implicit contour".
    parameters : name → value, as used (alpha may have been raised to what the levels need).
    core_s : seconds of processor time, all threads, judging included.
    n_faces : of the surface; None where none was made. dropped_area : share lost with loose pieces.
    distance : light-field distance to the original, None where the surface was not fit to be compared.
    refused : why, in words; None where the attempt was accepted.
    """

    method: str
    parameters: dict[str, float]
    core_s: float
    n_faces: int | None
    dropped_area: float
    distance: float | None
    refused: str | None


@dataclass(frozen=True, slots=True, eq=False)
class AttemptResult:
    """An attempt and, where it was accepted, its surface."""

    attempt: Attempt
    surface: TriMesh | None


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """The surface with about `n_faces` faces.

    mesh : None where the level is absent; absent : then why, in words; else None.
    method : the reducer, "none" where the surface has no more faces than that, empty where absent.
    distance : light-field distance to the original. core_s : seconds of processor time.
    """

    n_faces: int
    mesh: TriMesh | None
    method: str
    distance: float | None
    absent: str | None
    core_s: float


@dataclass(frozen=True, slots=True, eq=False)
class RemeshResult:
    """What became of a shape.

    surface : the accepted closed manifold, in full detail; None where every attempt was refused.
    is_as_is : the surface is the original itself, face by face, and small enough to be used so.
    attempts : all that was tried, in order. levels : one for each asked for, finest first; empty without a surface.
    """

    surface: TriMesh | None
    is_as_is: bool
    attempts: tuple[Attempt, ...]
    levels: tuple[Level, ...]

    def working_mesh(self, n_faces: int) -> TriMesh | None:
        """The mesh to label where `n_faces` are wanted; None where every attempt was refused.

        The original where it was accepted as it is; else the finest level reached of at most `n_faces` (a level's
        tolerance aside); else the surface, when it is itself no finer; else the coarsest level.
        """
        if self.surface is None or self.is_as_is:
            return self.surface
        reached = [(level.n_faces, level.mesh) for level in self.levels if level.mesh is not None]
        fitting = [mesh for size, mesh in reached if size <= n_faces]
        if self.surface.n_faces <= n_faces:
            return self.surface
        if fitting:
            return fitting[0]
        return reached[-1][1] if reached else self.surface


class Ladder:
    """The steps for one mesh: `as_is`, then `attempt(0)`, `attempt(1)` … until one has a surface, then `level`s.

    Holds the original's light field, which every step compares with. Steps are independent: after a crash, another
    process can go on with the next attempt.

    Raises
    ------
    DegenerateMeshError : the mesh has no extent, so that nothing can be compared with it.
    """

    def __init__(self, mesh: TriMesh, parameters: RemeshParameters, renderer: DepthRenderer) -> None:
        self._mesh = mesh
        self._parameters = parameters
        self._renderer = renderer
        self._light_field = light_field(mesh, renderer)

    def as_is(self) -> AttemptResult:
        """The original. A clean one with too many faces is accepted as a surface to decimate, not to use as it is."""
        started = time.process_time()
        defects = defects_of(self._mesh)
        attempt = Attempt("as is", {}, _since(started), self._mesh.n_faces, 0.0, 0.0, defects)
        return AttemptResult(attempt, self._mesh if defects is None else None)

    def attempt(self, index: int) -> AttemptResult:
        """Runs the attempt `index` of the parameters' `attempts`.

        Raises
        ------
        ParameterError : there is no such attempt.
        """
        attempts = self._parameters.attempts
        if not 0 <= index < len(attempts):
            raise ParameterError(
                f"attempts are 0 to {len(attempts) - 1} but {index} was asked for; stop after the last"
            )
        started = time.process_time()
        try:
            used, raw = self._raw_surface(attempts[index])
        except (DegenerateMeshError, MeshError) as error:
            return AttemptResult(_refused(attempts[index], started, str(error)), None)
        outer = largest_outer_component(raw)
        if outer.dropped_area > self._parameters.max_dropped_area:
            pieces = "1 loose piece holds" if outer.n_dropped == 1 else f"{outer.n_dropped} loose pieces hold"
            refused = (
                f"{pieces} {outer.dropped_area:.1%} of the area where at most "
                f"{self._parameters.max_dropped_area:.1%} may be dropped"
            )
            return AttemptResult(_refused(used, started, refused, raw.n_faces, outer.dropped_area), None)
        verdict = judge(outer.mesh, self._light_field, self._renderer, self._parameters.max_distance)
        attempt = Attempt(
            method_name(used),
            asdict(used),
            _since(started),
            outer.mesh.n_faces,
            outer.dropped_area,
            verdict.distance,
            verdict.refused,
        )
        return AttemptResult(attempt, outer.mesh if verdict.is_accepted else None)

    def level(self, surface: TriMesh, n_faces: int) -> Level:
        """The accepted surface with about `n_faces` faces, or why there is none. Never more faces than the surface."""
        started = time.process_time()
        tolerance = self._parameters.level_tolerance
        if surface.n_faces < n_faces * (1.0 - tolerance):
            return Level(n_faces, None, "", None, f"the surface has {surface.n_faces} faces only", _since(started))
        reduced = decimate(surface, n_faces, tolerance)
        if reduced.mesh is None:
            return Level(n_faces, None, "", None, "; ".join(reduced.failures), _since(started))
        verdict = judge(reduced.mesh, self._light_field, self._renderer, self._parameters.max_distance)
        mesh = reduced.mesh if verdict.is_accepted else None
        method = reduced.method if verdict.is_accepted else ""
        return Level(n_faces, mesh, method, verdict.distance, verdict.refused, _since(started))

    def _raw_surface(self, attempt: AttemptParameters) -> tuple[AttemptParameters, TriMesh]:
        if isinstance(attempt, AlphaWrap):
            fitted = fitted_wrap(self._mesh, attempt, self._parameters.n_wrap_faces)
            return fitted, alpha_wrap(self._mesh, fitted)
        return attempt, implicit_contour(self._mesh, attempt)


def remesh(mesh: TriMesh, parameters: RemeshParameters, renderer: DepthRenderer) -> RemeshResult:
    """The mesh as a closed manifold in one piece, at every level that its surface holds.

    Runs native code without a deadline: a caller with many shapes supervises `Ladder`'s steps instead.

    Raises
    ------
    DegenerateMeshError : the mesh has no extent.
    """
    ladder = Ladder(mesh, parameters, renderer)
    results = [ladder.as_is()]
    for index in range(len(parameters.attempts)):
        if results[-1].surface is not None:
            break
        results.append(ladder.attempt(index))
    surface = results[-1].surface
    levels = () if surface is None else tuple(ladder.level(surface, n_faces) for n_faces in parameters.levels)
    return collect(mesh, parameters, results, levels)


def collect(
    mesh: TriMesh, parameters: RemeshParameters, results: list[AttemptResult], levels: tuple[Level, ...]
) -> RemeshResult:
    """One result of steps that were run apart; `results` in the order they were run.

    Raises
    ------
    ConflictError : no steps, or a surface before the last.
    """
    if not results or any(result.surface is not None for result in results[:-1]):
        raise ConflictError(f"the last of {len(results)} attempts, and no other, may have a surface; stop at the first")
    surface = results[-1].surface
    is_as_is = surface is mesh and why_not_as_is(mesh, parameters.max_faces_as_is) is None
    return RemeshResult(surface, is_as_is, tuple(result.attempt for result in results), levels)


def method_name(attempt: AttemptParameters) -> str:
    """What an attempt with such parameters is called on record."""
    return "alpha wrap" if isinstance(attempt, AlphaWrap) else "implicit contour"


def _refused(
    attempt: AttemptParameters, started: float, why: str, n_faces: int | None = None, dropped_area: float = 0.0
) -> Attempt:
    return Attempt(method_name(attempt), asdict(attempt), _since(started), n_faces, dropped_area, None, why)


def _since(started: float) -> float:
    return time.process_time() - started
