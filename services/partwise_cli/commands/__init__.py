"""The commands, grouped as `partwise --help` shows them. Each module has `register(app)`."""
