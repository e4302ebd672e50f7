"""The `partwise` command: the only place that composes stores, workers and service."""
