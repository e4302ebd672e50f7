"""What the remeshing ladder makes of a folder of meshes, and what it costs: attempts, levels, core-seconds.

Each shape has a process of its own, which is ended at a deadline: native code may hang or die, and the rest goes on.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from statistics import median

import numpy as np

from partwise.errors import NotFoundError, PartwiseError
from partwise.io.read import read_mesh
from partwise.mesh import TriMesh
from partwise.remesh.ladder import Level, RemeshResult, remesh
from partwise.remesh.parameters import RemeshParameters
from partwise.render.contact_sheet import Tile, contact_sheet, save_png
from partwise.render.raycast import RayCastRenderer
from partwise.workspace.ingest import mesh_files

COLUMNS = 6
"""Of the contact sheet: three pairs of before and after."""

GREY, BLUE = (184, 184, 184), (140, 173, 219)


@dataclass(frozen=True, slots=True)
class LevelOutcome:
    """reached : its faces, None where it is absent; absent : then why. core_s : of all attempts and of this level.

    Attempts cost more the finer the finest level is: what one level costs by itself takes a run with that level only.
    """

    n_faces: int
    reached: int | None
    absent: str | None
    distance: float | None
    core_s: float


@dataclass(frozen=True, slots=True)
class RemeshOutcome:
    """refused : why there is no surface, None where there is one. attempts : what was tried, each with its outcome.

    distance : light-field distance of the accepted surface to the original. core_s : of all attempts and levels.
    """

    file: str
    n_faces: int
    is_as_is: bool
    refused: str | None
    attempts: tuple[str, ...]
    distance: float | None
    levels: tuple[LevelOutcome, ...]
    core_s: float


@dataclass(frozen=True, slots=True)
class RemeshSummary:
    """n_accepted : shapes with a surface. Medians are over those that were remeshed, so not over those as they are.

    core_s_to, n_reached : faces → median core-seconds of attempts and this level where reached; how often it was.
    """

    n_shapes: int
    n_accepted: int
    n_as_is: int
    refused: tuple[str, ...]
    core_s_to: dict[int, float]
    n_reached: dict[int, int]
    distance: float | None
    core_s: float | None


def measure_remeshing(
    folder: Path, levels: Sequence[int], deadline_s: float, keep: Path | None = None
) -> Iterator[RemeshOutcome]:
    """Remeshes each mesh below the folder. keep : folder for the picture's meshes, `<number>-before` and `-after`.

    Raises
    ------
    NotFoundError : no mesh below the folder, or no such folder.
    ParameterError : levels that do not descend.
    """
    files = list(mesh_files(folder)) if folder.is_dir() else []
    if not files:
        raise NotFoundError(f"remeshing is measured on mesh files but {folder} has none; check the path")
    parameters = replace(RemeshParameters(), levels=tuple(levels))
    for number, file in enumerate(files):
        yield supervised(file, str(file.relative_to(folder)), parameters, deadline_s, keep, number)


def supervised(
    file: Path, name: str, parameters: RemeshParameters, deadline_s: float, keep: Path | None, number: int
) -> RemeshOutcome:
    """One shape in a process of its own."""
    context = get_context("spawn")  # a forked child would inherit the locks of the numerical libraries' threads
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(theirs, file, name, parameters, keep, number), daemon=True)
    process.start()
    theirs.close()
    try:
        if not ours.poll(deadline_s):
            return _lost(name, f"it took longer than {deadline_s:g} s")
        outcome: RemeshOutcome = ours.recv()
    except EOFError:
        process.join()
        return _lost(name, f"its process died with exit code {process.exitcode}")
    else:
        return outcome
    finally:
        process.kill()
        process.join()


def _work(
    answer: Connection, file: Path, name: str, parameters: RemeshParameters, keep: Path | None, number: int
) -> None:
    try:
        mesh = read_mesh(file)
        with RayCastRenderer() as renderer:
            result = remesh(mesh, parameters, renderer)
    except PartwiseError as error:
        answer.send(_lost(name, str(error)))
        return
    if keep is not None:
        _keep(keep, number, mesh, result)
    answer.send(outcome_of(name, mesh, result))


def outcome_of(name: str, mesh: TriMesh, result: RemeshResult) -> RemeshOutcome:
    """What to say of a result."""
    attempts_s = sum(attempt.core_s for attempt in result.attempts)
    tried = tuple(f"{attempt.method}: {attempt.refused or 'accepted'}" for attempt in result.attempts)
    refused = None if result.surface is not None else result.attempts[-1].refused
    return RemeshOutcome(
        name,
        mesh.n_faces,
        result.is_as_is,
        refused,
        tried,
        result.attempts[-1].distance,
        tuple(_level(level, attempts_s) for level in result.levels),
        round(attempts_s + sum(level.core_s for level in result.levels), 3),
    )


def _level(level: Level, attempts_s: float) -> LevelOutcome:
    reached = None if level.mesh is None else level.mesh.n_faces
    return LevelOutcome(level.n_faces, reached, level.absent, level.distance, round(attempts_s + level.core_s, 3))


def _lost(name: str, why: str) -> RemeshOutcome:
    return RemeshOutcome(name, 0, False, why, (), None, (), 0.0)


def summarise(outcomes: Sequence[RemeshOutcome]) -> RemeshSummary:
    """Of all outcomes."""
    accepted = [outcome for outcome in outcomes if outcome.refused is None]
    made = [outcome for outcome in accepted if not outcome.is_as_is]
    core_s: dict[int, list[float]] = {}
    for outcome in made:
        for level in outcome.levels:
            core_s.setdefault(level.n_faces, [])
            if level.reached is not None:
                core_s[level.n_faces].append(level.core_s)
    distances = [outcome.distance for outcome in made if outcome.distance is not None]
    return RemeshSummary(
        len(outcomes),
        len(accepted),
        len(accepted) - len(made),
        tuple(f"{outcome.file}: {outcome.refused}" for outcome in outcomes if outcome.refused is not None),
        {n_faces: round(median(seconds), 2) for n_faces, seconds in core_s.items() if seconds},
        {n_faces: len(seconds) for n_faces, seconds in core_s.items()},
        round(median(distances), 4) if distances else None,
        round(median(outcome.core_s for outcome in made), 2) if made else None,
    )


def _keep(folder: Path, number: int, mesh: TriMesh, result: RemeshResult) -> None:
    from partwise.io.write import write_mesh

    write_mesh(mesh, folder / f"{number}-before.off")
    reached = [level.mesh for level in result.levels if level.mesh is not None]
    after = reached[-1] if reached else result.surface
    if after is not None:
        write_mesh(after, folder / f"{number}-after.off")


def write_pictures(outcomes: Sequence[RemeshOutcome], kept: Path, path: Path) -> None:
    """The contact sheet of what was kept: each shape as it came, beside its coarsest level. None, if nothing was."""
    tiles = []
    for number, outcome in enumerate(outcomes):
        before, after = (kept / f"{number}-{when}.off" for when in ("before", "after"))
        if before.exists() and after.exists():
            how = outcome.attempts[-1].partition(":")[0]
            distance = "" if outcome.distance is None else f"distance {outcome.distance:.3f}"
            tiles += [_tile(before, GREY, outcome.file), _tile(after, BLUE, how, distance)]
    if tiles:
        save_png(contact_sheet(tiles, COLUMNS, title="Before and after remeshing"), path)


def _tile(file: Path, colour: tuple[int, int, int], *caption: str) -> Tile:
    mesh = read_mesh(file)
    first, *rest = caption
    lines = (first, ", ".join([f"{mesh.n_faces:,} faces", *filter(None, rest)]))
    return Tile(mesh, np.tile(np.array(colour, dtype=np.uint8), (mesh.n_faces, 1)), lines)
