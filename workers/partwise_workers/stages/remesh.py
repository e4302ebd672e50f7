"""Stage `remesh`: a closed manifold in one piece at several resolutions, one of which is described and labelled.

What it stores is judged as stored, in float32: rounding could collapse a face.
"""

import logging
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from partwise.errors import StageRefusedError
from partwise.mesh import TriMesh
from partwise.remesh.parameters import RemeshParameters
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import REMESH
from partwise.store.blocks import BlockKind
from partwise.store.levels import remeshed_arrays
from partwise.workspace.settings import CollectionSettings, RemeshPolicy
from partwise_workers.stage import RunStage, ShapeInputs, StageResult, reason_of
from partwise_workers.stages import mesh as mesh_stage

if TYPE_CHECKING:
    from partwise.remesh.ladder import Attempt, AttemptResult, Ladder, Level, RemeshResult
    from partwise.render.views import DepthRenderer

logger = logging.getLogger(__name__)

NAME = "remesh"

LEVEL_RECORD = ("method", "distance", "absent", "core_s")
"""What goes on record of a level without a mesh."""


@dataclass(frozen=True, slots=True)
class RemeshStage:
    """Makes the mesh that later stages read. The working resolution is one of the levels, configured or not.

    working_faces : faces that the working mesh should have. policy : "never" takes every original as it is.
    """

    parameters: RemeshParameters
    working_faces: int
    policy: RemeshPolicy

    @classmethod
    def of(cls, parameters: RemeshParameters, settings: CollectionSettings) -> "RemeshStage":
        """The stage of a collection: parameters are the workspace's, the resolution is its own."""
        levels = tuple(sorted({*parameters.levels, settings.working_faces}, reverse=True))
        return cls(replace(parameters, levels=levels), settings.working_faces, settings.remesh)

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> str:
        return mesh_stage.NAME

    @property
    def block_kind(self) -> BlockKind:
        return REMESH

    @property
    def n_steps(self) -> int:
        return 1 if self.policy == "never" else len(self.parameters.attempts) + len(self.parameters.levels)

    @property
    def identity(self) -> Mapping[str, object]:
        how = {} if self.policy == "never" else {"working_faces": self.working_faces, **asdict(self.parameters)}
        return {"version": 1, "policy": self.policy, **how}

    @contextmanager
    def open(self, arrays: ArrayStore) -> Iterator[RunStage]:  # noqa: ARG002 - the protocol's
        if self.policy == "never":
            yield self._take_as_it_is
            return
        from partwise.render.raycast import RayCastRenderer  # loads what drivers can do without

        # Ray casting: the distances of docs/remeshing.md were measured with it, and it shares no GL context.
        with RayCastRenderer() as renderer:
            yield lambda inputs: self._remesh(renderer, inputs)

    def _take_as_it_is(self, inputs: ShapeInputs) -> StageResult:
        original = mesh_stage.stored_mesh(inputs)
        levels = [_level_account(n, None, absent="not asked for") for n in self.parameters.levels]
        summary = self._summary(original, original, is_as_is=True, attempts=[], levels=levels)
        return StageResult(remeshed_arrays(original, [(n, None) for n in self.parameters.levels]), summary)

    def _remesh(self, renderer: "DepthRenderer", inputs: ShapeInputs) -> StageResult:
        from partwise.remesh.ladder import Ladder, collect

        original = mesh_stage.stored_mesh(inputs)
        ladder = Ladder(original, self.parameters, renderer)
        results = self._attempts(ladder, inputs)
        surface = results[-1].surface
        levels = () if surface is None else tuple(self._levels(ladder, surface, inputs))
        result = collect(original, self.parameters, results, levels)
        working = result.working_mesh(self.working_faces)
        if working is None:
            raise _refusal(result.attempts)
        return self._result(original, working, result)

    def _attempts(self, ladder: "Ladder", inputs: ShapeInputs) -> list["AttemptResult"]:
        """Tries one after the other until one is accepted; those that failed on an earlier try are passed over."""
        results = [ladder.as_is()]
        for index, parameters in enumerate(self.parameters.attempts):
            if results[-1].surface is not None:
                break
            step = f"attempt {index}"
            if step in inputs.failed_steps:
                results.append(_not_made(parameters, inputs.failed_steps[step]))
            elif step in inputs.refused_steps:
                results.append(_recorded_attempt(inputs.refused_steps[step]))
            else:
                inputs.begin(step)
                results.append(_attempted(ladder, index, parameters))
                if results[-1].surface is None:
                    inputs.refuse(step, asdict(results[-1].attempt))
        return results

    def _levels(self, ladder: "Ladder", surface: TriMesh, inputs: ShapeInputs) -> Iterator["Level"]:
        for n_faces in self.parameters.levels:
            step = f"level {n_faces}"
            if step in inputs.failed_steps:
                yield _absent(n_faces, inputs.failed_steps[step])
            elif step in inputs.refused_steps:
                yield _recorded_level(n_faces, inputs.refused_steps[step])
            else:
                inputs.begin(step)
                level = _made_level(ladder, surface, n_faces)
                if level.mesh is None:
                    inputs.refuse(step, {name: getattr(level, name) for name in LEVEL_RECORD})
                yield level

    def _result(self, original: TriMesh, working: TriMesh, result: "RemeshResult") -> StageResult:
        attempts = [asdict(attempt) for attempt in result.attempts]
        levels = [
            _level_account(each.n_faces, each.mesh, each.absent, each.method, each.distance, each.core_s)
            for each in result.levels
        ]
        summary = self._summary(original, working, is_as_is=result.is_as_is, attempts=attempts, levels=levels)
        chosen = [level.n_faces for level in result.levels if level.mesh is working]
        summary["working_level"] = chosen[0] if chosen else None
        arrays = remeshed_arrays(working, [(level.n_faces, level.mesh) for level in result.levels])
        return StageResult(arrays, summary)

    def _summary(
        self,
        original: TriMesh,
        working: TriMesh,
        *,
        is_as_is: bool,
        attempts: Sequence[Mapping[str, Any]],
        levels: Sequence[Mapping[str, Any]],
    ) -> dict[str, Any]:
        """What `partwise.workspace.provenance` reads."""
        return {
            "mesh_hash": working.content_hash(),
            "original_mesh_hash": original.content_hash(),
            "n_vertices": working.n_vertices,
            "n_faces": working.n_faces,
            "is_as_is": is_as_is,
            "policy": self.policy,
            "working_faces": self.working_faces,
            "working_level": None,
            "attempts": attempts,
            "levels": levels,
        }


def working_mesh(inputs: ShapeInputs) -> TriMesh:
    """The mesh that this stage made of the shape in hand: what is described, predicted and labelled."""
    return TriMesh(inputs.array(NAME, "vertices"), inputs.array(NAME, "faces"))


def _storable(result: "AttemptResult") -> "AttemptResult":
    """The result, its surface refused where rounding to what is stored breaks it."""
    defects = None if result.surface is None else _defects_as_stored(result.surface)
    if defects is None:
        return result
    return replace(result, attempt=replace(result.attempt, refused=defects), surface=None)


def _storable_level(level: "Level") -> "Level":
    defects = None if level.mesh is None else _defects_as_stored(level.mesh)
    return level if defects is None else replace(level, mesh=None, method="", absent=defects)


def _defects_as_stored(mesh: TriMesh) -> str | None:
    from partwise.remesh.accept_as_is import defects_of

    defects = defects_of(TriMesh(mesh.vertices.astype(np.float32), mesh.faces))
    return None if defects is None else f"rounded to float32 it has {defects}"


def _attempted(ladder: "Ladder", index: int, parameters: Any) -> "AttemptResult":
    """An attempt; whatever its libraries raise refuses it and no more, so that the next one is tried."""
    started = time.process_time()
    try:
        return _storable(ladder.attempt(index))
    except Exception as error:  # a step's edge: native libraries raise types of their own
        logger.warning("an attempt failed", exc_info=True)
        return _not_made(parameters, reason_of(error), time.process_time() - started)


def _made_level(ladder: "Ladder", surface: TriMesh, n_faces: int) -> "Level":
    """A level; whatever its libraries raise costs only this one."""
    started = time.process_time()
    try:
        return _storable_level(ladder.level(surface, n_faces))
    except Exception as error:  # as for attempts
        logger.warning("a level failed", exc_info=True)
        return _absent(n_faces, reason_of(error), time.process_time() - started)


def _recorded_attempt(record: Mapping[str, Any]) -> "AttemptResult":
    """An attempt that was refused on an earlier try, as it was."""
    from partwise.remesh.ladder import Attempt, AttemptResult

    return AttemptResult(Attempt(**record), None)


def _recorded_level(n_faces: int, record: Mapping[str, Any]) -> "Level":
    from partwise.remesh.ladder import Level

    return Level(n_faces, None, **record)


def _not_made(parameters: Any, why: str, core_s: float = 0.0) -> "AttemptResult":
    from partwise.remesh.ladder import Attempt, AttemptResult, method_name

    return AttemptResult(Attempt(method_name(parameters), asdict(parameters), core_s, None, 0.0, None, why), None)


def _absent(n_faces: int, why: str, core_s: float = 0.0) -> "Level":
    from partwise.remesh.ladder import Level

    return Level(n_faces, None, "", None, why, core_s)


def _level_account(
    n_faces: int,
    mesh: TriMesh | None,
    absent: str | None,
    method: str = "",
    distance: float | None = None,
    core_s: float = 0.0,
) -> dict[str, Any]:
    return {
        "n_faces": n_faces,
        "reached": None if mesh is None else mesh.n_faces,
        "mesh_hash": None if mesh is None else mesh.content_hash(),
        "method": method,
        "distance": distance,
        "absent": absent,
        "core_s": core_s,
    }


def _refusal(attempts: "Sequence[Attempt]") -> StageRefusedError:
    """Names the attempt that came nearest: the least distance, else the last."""
    made = attempts[1:]
    judged = [attempt for attempt in made if attempt.distance is not None]
    telling = min(judged, key=lambda attempt: attempt.distance or 0.0) if judged else made[-1]
    which = "nearest" if judged else "last"
    return StageRefusedError(
        f"remeshing must end with one closed surface like the original but all {len(made)} attempts were refused, the "
        f"{which} ({telling.method}) because: {telling.refused}; mend the file, or loosen that limit under [remesh] in "
        "partwise.toml (`partwise settings --remesh never` takes every shape of the collection as it is)",
        {"attempts": [asdict(attempt) for attempt in attempts]},
    )
