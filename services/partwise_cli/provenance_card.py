"""What `partwise status --shape` shows: a shape's provenance card, for people to read."""

import typer

from partwise.geometry.manifold import ManifoldReport
from partwise.workspace.provenance import AttemptCard, LevelCard, OriginalCard, ProvenanceCard, StageCard, WorkingCard
from partwise_cli.terminal import console, counted, print_table

_LABEL_WIDTH = 9
_HASH_LENGTH = 12
_NOTHING = "–"


def print_card(card: ProvenanceCard) -> None:
    """Source, original, attempts, levels, working mesh, stages, failures: whatever there is of it, in that order."""
    _line("Shape", f"{card.source_key}, number {card.shape_id}: {card.state}")
    _line("Source", f"{_short(card.source_hash)}, ingested {_when(card.ingested_at)}")
    _line("Original", _original(card.original))
    _line("Working", _working(card.working))
    if not card.stages:
        typer.echo("No stage has run yet: go on with `partwise preprocess`.")
        return
    if card.attempts:
        rows = [_attempt(number, attempt) for number, attempt in enumerate(card.attempts)]
        print_table(
            "Attempts", ("", "method", "core s", "faces", "lost area", "distance", "outcome"), rows, (0, 2, 3, 4, 5)
        )
    if card.levels:
        reached = card.working.level if card.working else None
        rows = [_level(level, is_working=level.n_faces == reached) for level in card.levels]
        print_table("Levels", ("faces asked", "reached", "method", "core s", "distance", ""), rows, (0, 1, 3, 4))
    rows = [_stage(stage) for stage in card.stages]
    print_table("Stages", ("stage", "", "finished (UTC)", "s", "tries", "key", "block"), rows, (3, 4))
    for stage in card.stages:
        _print_failure(stage)


def _line(label: str, value: str) -> None:
    console().print(f"[bold]{label:<{_LABEL_WIDTH}}[/bold]", end="")
    console().print(value, markup=False, soft_wrap=True)


def _original(original: OriginalCard | None) -> str:
    if original is None:
        return "not read yet"
    mesh = original.mesh
    return (
        f"{_short(mesh.mesh_hash)}, {mesh.n_faces:,} faces, {mesh.n_vertices:,} vertices; {_in_words(original.report)}"
    )


def _working(working: WorkingCard | None) -> str:
    if working is None:
        return "none yet"
    if working.is_as_is:
        return "the original as it is" + (", as the collection is set" if working.policy == "never" else "")
    mesh = working.mesh
    source = "the whole surface" if working.level is None else f"level {working.level:,}"
    wanted = "" if working.level == working.working_faces else f", where {working.working_faces:,} faces were wanted"
    return f"{_short(mesh.mesh_hash)}, {mesh.n_faces:,} faces, {mesh.n_vertices:,} vertices; {source}{wanted}"


def _in_words(report: ManifoldReport) -> str:
    if report.is_clean:
        return "a closed manifold in one piece"
    counts = {
        "component": report.n_components,
        "boundary edge": report.n_boundary_edges,
        "non-manifold edge": report.n_nonmanifold_edges,
        "misoriented edge": report.n_misoriented_edges,
        "degenerate face": report.n_degenerate_faces,
        "duplicate face": report.n_duplicate_faces,
    }
    words = [counted(n, noun) for noun, n in counts.items() if n]
    if report.n_nonmanifold_vertices:
        n = report.n_nonmanifold_vertices
        words.append(f"{n:,} non-manifold {'vertex' if n == 1 else 'vertices'}")
    return ", ".join(words)


def _attempt(number: int, attempt: AttemptCard) -> tuple[str, ...]:
    return (
        str(number),
        ", ".join([attempt.method, *_parameters(attempt)]),
        f"{attempt.core_s:.1f}",
        _NOTHING if attempt.n_faces is None else f"{attempt.n_faces:,}",
        f"{attempt.dropped_area:.1%}",
        _distance(attempt.distance),
        "accepted" if attempt.refused is None else attempt.refused,
    )


def _parameters(attempt: AttemptCard) -> list[str]:
    """`0.3 %`, `offset 0.1 %`: a parameter's last word is its unit; what the method's name says is not said again."""
    words = []
    for name, value in attempt.parameters.items():
        noun, _, unit = name.rpartition("_")
        amount = f"{value:.3g} {'%' if unit == 'percent' else unit}"
        words.append(amount if noun == "n" or noun in attempt.method else f"{noun} {amount}")
    return words


def _level(level: LevelCard, *, is_working: bool) -> tuple[str, ...]:
    note = level.absent or ("the working mesh" if is_working else "")
    return (
        f"{level.n_faces:,}",
        "absent" if level.reached is None else f"{level.reached:,}",
        {"none": "surface as it is", "": _NOTHING}.get(level.method, level.method),
        f"{level.core_s:.1f}",
        _distance(level.distance),
        note,
    )


def _stage(stage: StageCard) -> tuple[str, ...]:
    place = _NOTHING if stage.block is None else f"…{stage.block[-_HASH_LENGTH:]}, row {stage.row}"  # its end is unique
    return (
        stage.stage,
        "done" if stage.failure is None else "failed",
        _when(stage.finished_at),
        f"{stage.seconds:.1f}",
        str(stage.attempts),
        _short(stage.key),
        place,
    )


def _print_failure(stage: StageCard) -> None:
    if stage.failure is None:
        return
    kind = f" ({stage.failure.kind})" if stage.failure.kind else ""
    console().print(f"\n[bold red]{stage.stage} failed{kind}[/bold red]", end=" ")
    console().print(stage.failure.reason, markup=False)
    for step, why in stage.failure.steps:
        console().print(f"  {step}: {why}", markup=False)
    for line in stage.failure.log:
        console().print(f"  {line}", markup=False, style="dim", soft_wrap=True)


def _distance(value: float | None) -> str:
    return _NOTHING if value is None else f"{value:.3f}"


def _short(digest: str) -> str:
    return digest[:_HASH_LENGTH]


def _when(iso: str) -> str:
    return iso[:16].replace("T", " ")
