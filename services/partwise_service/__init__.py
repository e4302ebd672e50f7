"""The HTTP service that annotators' browsers talk to. So far only its place and its import rules exist.

It may import `partwise`, but neither torch, Ray, pymeshlab, pyrender nor `partwise.learning`, so that it installs
small and starts fast; `make check` enforces that.
"""
