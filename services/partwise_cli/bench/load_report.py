"""What a load came to, as tables."""

import typer

from partwise_cli.bench.load import LoadReport, PeopleReport, Times
from partwise_cli.terminal import counted, print_table, warning_lines


def print_load(report: LoadReport) -> None:
    """Every kind of page and of request by name, then what must hold, then how busy the machine was."""
    about = f"{report.request.database.partition(':')[0]}, {counted(report.request.n_shapes, 'shape')}"
    if report.pages:
        rows = [(page.order, page.filter, page.where, *_cells(page.times)) for page in report.pages]
        print_table(f"Pages of the table: {about}", ("order", "filter", "page", *_COLUMNS), rows, (3, 4, 5, 6))
        worst = max(report.pages, key=lambda page: page.times.p99_ms)
        typer.echo(f"the slowest p99: {worst.times.p99_ms:g} ms, by {worst.order}, {worst.filter}, {worst.where}")
    if report.people is not None:
        _print_people(f"{counted(report.request.n_people, 'annotator')} at work: {about}", report.people)
    before, after = report.load_average
    typer.echo(f"load average {before:.2f} before, {after:.2f} after, on {counted(report.n_cpus, 'processor')}")


def _print_people(title: str, people: PeopleReport) -> None:
    rows = [(what, *_cells(times)) for what, times in {**people.times, "sent late by": people.late}.items()]
    print_table(title, ("request", *_COLUMNS), rows, (1, 2, 3, 4))
    core_ms = ", ".join(f"{whose} {ms:g}" for whose, ms in people.core_ms.items())
    typer.echo(
        f"{people.requests_a_s:g} requests a second, core-ms for each: {core_ms}; the service took "
        f"{people.service_load:.0%} of a processor"
    )
    checks = people.checks
    typer.echo(
        f"{checks.n_leases:,} leases: {len(checks.slots_leased_twice)} slots leased twice at once, "
        f"{len(checks.seen_by_two_people)} shapes seen by two people at once, "
        f"{len(checks.given_to_one_person_twice)} given to one person twice"
    )
    typer.echo(f"{checks.n_strokes:,} strokes: {len(checks.strokes_lost_or_twice)} drafts with one lost or twice")
    typer.echo(counted(len(people.errors), "error"))
    warning_lines(
        [
            *people.errors,
            *checks.slots_leased_twice,
            *checks.seen_by_two_people,
            *checks.given_to_one_person_twice,
            *checks.strokes_lost_or_twice,
        ]
    )


_COLUMNS = ("requests", "p50 ms", "p99 ms", "max ms")


def _cells(times: Times) -> tuple[str, ...]:
    return str(times.n), f"{times.p50_ms:.1f}", f"{times.p99_ms:.1f}", f"{times.max_ms:.1f}"
