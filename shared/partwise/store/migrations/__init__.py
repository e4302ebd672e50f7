"""Alembic migrations, shipped with the package and run by `partwise.store.migrate`. Append-only."""
