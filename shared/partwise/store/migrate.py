"""Bring a catalog's schema to the version this Partwise knows, or say why not."""

from functools import cache
from pathlib import Path
from typing import Any

from alembic.config import Config
from alembic.runtime.environment import EnvironmentContext
from alembic.runtime.migration import MigrationContext, RevisionStep
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, text

from partwise.errors import NotFoundError, StoreError
from partwise.store.engine import reading, writing

_MIGRATIONS = Path(__file__).parent / "migrations"
_LOCK = 7_046_029_254_386_353  # any number that no other use of the database takes as its advisory lock


@cache  # to read the migrations takes ten times as long as the rest of opening a catalog
def _revisions(folder: Path) -> tuple[str, ...]:
    """Those of the migrations in a folder, the newest first."""
    return tuple(script.revision for script in ScriptDirectory(str(folder)).walk_revisions())


def known_schema() -> str:
    """The newest schema revision that this Partwise knows."""
    revisions = _revisions(_MIGRATIONS)
    if not revisions:
        raise StoreError(f"there must be migrations in {_MIGRATIONS} but there are none; reinstall partwise")
    return revisions[0]


def refuse_other_schema(engine: Engine) -> None:
    """Let only a catalog of the known schema be opened.

    Raises
    ------
    NotFoundError : the database holds no catalog.
    StoreError : its schema is older (the remedy is `partwise migrate`) or newer (a newer Partwise made it).
    """
    with reading(engine) as connection:
        found = MigrationContext.configure(connection).get_current_revision()
    known = known_schema()
    where = engine.url.render_as_string(hide_password=True)
    if found is None:
        raise NotFoundError(f"there is no catalog at {where}; make one with `partwise init`")
    if found not in _revisions(_MIGRATIONS):
        raise StoreError(f"the catalog at {where} has schema {found}, newer than {known}; use a newer partwise")
    if found != known:
        raise StoreError(f"the catalog at {where} has schema {found}, older than {known}; run `partwise migrate`")


def migrate(engine: Engine, target: str = "head") -> None:
    """Run the migrations that the catalog lacks, all or none of them.

    Raises
    ------
    StoreError : a newer Partwise made the catalog, or the database refuses.
    """
    with writing(engine) as connection:
        if connection.dialect.name == "postgresql":
            connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": _LOCK})
        found = MigrationContext.configure(connection).get_current_revision()
        if found is not None and found not in _revisions(_MIGRATIONS):
            raise StoreError(f"the catalog has schema {found}, newer than {known_schema()}; use a newer partwise")
        _upgrade(connection, target)


def _upgrade(connection: Connection, target: str) -> None:
    scripts = ScriptDirectory(str(_MIGRATIONS))

    def steps(revision: Any, _context: MigrationContext) -> list[RevisionStep]:
        return scripts._upgrade_revs(target, revision)  # what alembic's own `upgrade` command calls

    with EnvironmentContext(Config(), scripts, fn=steps) as environment:
        environment.configure(connection=connection, transactional_ddl=True)
        environment.run_migrations()
