"""A file for each resource, each with a `router` that `partwise_service.app` names."""
