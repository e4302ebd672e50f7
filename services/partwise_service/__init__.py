"""The HTTP service that annotators' browsers talk to: thin, over the catalog and the array store of one workspace.

`app.create_app` makes the application from `settings.ServiceSettings`; `routes` has a file for each resource, `schemas`
what travels as JSON, `dependencies` what handlers ask for, `security` who may do what, `problems` every error answer.

It may import `partwise`, but neither torch, Ray, pymeshlab, pyrender nor `partwise.learning`, so that it installs
small and starts fast; `make check` enforces that.
"""
