"""A workspace: `partwise.toml` and the two stores it points to, and what people and commands do with them.

Everything here needs neither Ray nor torch, so that the service can use it as well as the command line.
"""
