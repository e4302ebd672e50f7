"""What the document says of every operation holds for whatever is sent: found by generated requests."""

import shutil
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import schemathesis
from fastapi import FastAPI
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, given, settings
from schemathesis.specs.openapi.checks import positive_data_acceptance

from partwise.store.records import NewToken, Role
from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

N_EXAMPLES = 8


@pytest.fixture(scope="module")
def served(template, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[FastAPI, str]]:
    """A running application and an admin's secret."""
    path = Path(shutil.copytree(template.path, tmp_path_factory.mktemp("fuzz") / "ws"))
    app = create_app(ServiceSettings(workspace=path, max_auth_failures=1_000_000, event_stream_s=0.0))
    with TestClient(app):
        catalog = app.state.service.workspace.catalog
        new = NewToken(catalog.add_person("ada").id, Role.ADMIN, datetime.now(UTC) + timedelta(days=1))
        yield app, catalog.issue_token(new, "test").secret


def _operations() -> list[tuple[str, str]]:
    document = create_app(ServiceSettings(workspace=Path("none"))).openapi()
    return [(method.upper(), path) for path, methods in document["paths"].items() for method in methods]


@pytest.mark.parametrize(("method", "path"), _operations())
def test_operations_keep_to_the_document(served, method: str, path: str) -> None:
    app, secret = served
    schema = schemathesis.openapi.from_asgi("/api/v1/openapi.json", app)

    @settings(
        max_examples=N_EXAMPLES,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(case=schema[path][method].as_strategy())
    def keeps_to_the_document(case) -> None:
        answer = case.call(headers={"Authorization": f"Bearer {secret}"})
        case.validate_response(answer, excluded_checks=[positive_data_acceptance])
        is_refused = answer.status_code == 422 and case.meta.generation.mode.is_positive
        # a rule of the domain may refuse what the document allows, such as a part's name with a comma; no schema may
        assert not (is_refused and "errors" in answer.json()), answer.text

    keeps_to_the_document()
