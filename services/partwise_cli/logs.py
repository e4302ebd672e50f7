"""Log records as lines on stderr, with the fields that a record carries beside its message."""

import logging
from typing import Any

import typer

_USUAL = frozenset(vars(logging.makeLogRecord({}))) | {"message", "asctime", "taskName"}


class StderrHandler(logging.Handler):
    """Writes to today's stderr, which tests and progress bars replace."""

    def emit(self, record: logging.LogRecord) -> None:
        typer.echo(self.format(record), err=True)


class FieldFormatter(logging.Formatter):
    """`warning: attempt failed (shape=a.off, attempt=1)`."""

    def format(self, record: logging.LogRecord) -> str:
        # an underscore marks what libraries note on records for themselves, as Ray does
        extra = (key for key in vars(record) if key not in _USUAL and not key.startswith("_"))
        fields: dict[str, Any] = {key: vars(record)[key] for key in extra}
        shown = f" ({', '.join(f'{key}={value}' for key, value in fields.items())})" if fields else ""
        return f"{record.levelname.lower()}: {record.getMessage()}{shown}"


def configure_logging(verbose: bool) -> None:
    """Warnings that are logged go to stderr; with `verbose` also what Partwise says of its own doing.

    Python's own warnings are for whoever calls a library wrongly: they are shown with `verbose` only.
    """
    root = logging.getLogger()
    if not any(isinstance(handler, StderrHandler) for handler in root.handlers):
        handler = StderrHandler()
        handler.setFormatter(FieldFormatter())
        root.addHandler(handler)
    root.setLevel(logging.WARNING)
    for package in ("partwise", "partwise_workers", "partwise_cli"):
        logging.getLogger(package).setLevel(logging.INFO if verbose else logging.WARNING)
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").setLevel(logging.WARNING if verbose else logging.ERROR)
