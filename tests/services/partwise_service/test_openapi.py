"""The document is complete, and what it is made of loads nothing heavy."""

import ast
import json
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest
from pydantic import ValidationError

import partwise_service
from partwise.errors import FileFormatError
from partwise.labels.stroke_json import stroke_from_document
from partwise_service.problems import MEDIA_TYPE, ProblemKind
from partwise_service.schemas.strokes import Stroke

SERVICE = Path(partwise_service.__file__).parent
CLEAR = {"v": 1, "kind": "clear", "id": "5b1f3c1e-6f0a-4f4e-9a53-0d6c1f1f8a10"}
GOLDEN = Path(__file__).parents[2] / "golden" / "strokes"

HEAVY = {"torch", "ray", "pymeshlab", "pyrender", "embreex", "numba", "cv2", "PIL", "sklearn", "trimesh", "igl"}


@pytest.fixture
def document(nobody):
    return nobody.get("/openapi.json").json()


def test_every_operation_names_every_problem(document) -> None:
    statuses = {str(kind.status) for kind in ProblemKind}
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            assert statuses <= set(operation["responses"]), (method, path)


def test_every_kind_of_problem_is_described(document) -> None:
    described = set()
    for response in document["components"]["responses"].values():
        reference = response["content"][MEDIA_TYPE]["schema"]["$ref"].rpartition("/")[2]
        described |= set(document["components"]["schemas"][reference]["properties"]["type"]["enum"])
    assert described == {kind.type for kind in ProblemKind}


def test_every_operation_says_what_it_is_for_and_has_a_name_of_its_own(document) -> None:
    operations = [each for methods in document["paths"].values() for each in methods.values()]
    assert all(operation.get("description") for operation in operations)
    assert len({operation["operationId"] for operation in operations}) == len(operations)


def test_every_operation_but_logging_in_takes_credentials(document) -> None:
    open_to_all = {
        (method, path)
        for path, methods in document["paths"].items()
        for method, operation in methods.items()
        if not operation.get("security")
    }
    assert open_to_all == {("post", "/api/v1/login")}


def test_every_operation_but_logging_in_is_closed_without_credentials(document, client) -> None:
    for path, methods in document["paths"].items():
        concrete = re.sub(r"\{(\w+)\}", lambda name: "0" * 64 if name[1] == "mesh_hash" else "1", path)
        for method in methods:
            if path != "/api/v1/login":
                answer = client.request(method.upper(), concrete, params={"shape_id": 1})
                assert answer.status_code == 401, (method, path)


def _operation(document, operation_id: str):
    operations = [each for methods in document["paths"].values() for each in methods.values()]
    return next(each for each in operations if each["operationId"] == operation_id)


def _members(document, schema) -> set[str]:
    """What an object of this schema may have."""
    if "$ref" in schema:
        return _members(document, document["components"]["schemas"][schema["$ref"].rpartition("/")[2]])
    parts = [*schema.get("allOf", ()), *schema.get("anyOf", ())]
    return set(schema.get("properties", {})).union(*(_members(document, part) for part in parts))


def _declared(document, operation_id: str, status: int) -> set[str]:
    response = _operation(document, operation_id)["responses"][str(status)]
    if "$ref" in response:
        response = document["components"]["responses"][response["$ref"].rpartition("/")[2]]
    return _members(document, response["content"][MEDIA_TYPE]["schema"])


@dataclass
class Work:
    """An annotator's lease and draft."""

    caller: Any
    lease: str
    draft: str

    def ask(self, path: str, headers: Mapping[str, str] = MappingProxyType({}), **body: Any) -> Any:
        return self.caller.post(path, json=body, headers=dict(headers))


@pytest.fixture
def work(annotator, mugs) -> Work:
    lease = annotator.post("/queue/claim", json={"collection_id": mugs.collection_id}).json()["items"][0]
    draft = annotator.post(f"/leases/{lease['id']}/draft", json={}).json()
    return Work(annotator, f"/leases/{lease['id']}", f"/drafts/{draft['id']}")


def _stale_strokes(work: Work) -> Any:
    person_id = work.caller.get("/me").json()["person_id"]
    place = {"sequence": 3, "base_revision": None, "author_id": person_id, "at": "2026-11-22T12:00:00Z"}
    return work.ask(f"{work.draft}/strokes", expected_sequence=3, strokes=[CLEAR | place])


def _stale_confirmation(work: Work) -> Any:
    return work.ask(f"{work.draft}/confirm", headers={"If-Match": '"3"'})


def _stale_completion(work: Work) -> Any:
    return work.ask(f"{work.lease}/complete", n_strokes=3)


def _stale_acknowledgement(work: Work) -> Any:
    return work.ask(f"{work.draft}/acknowledge", revision_id=7)


def _late_renewal(work: Work) -> Any:
    work.ask(f"{work.lease}/release")
    return work.ask(f"{work.lease}/heartbeat")


def _invalid_request(work: Work) -> Any:
    return work.ask(f"{work.draft}/acknowledge")


@pytest.mark.parametrize(
    ("ask", "operation_id", "own"),
    [
        (_stale_strokes, "append_strokes", {"state", "recorded", "refused"}),
        (_stale_confirmation, "confirm_draft", {"state", "recorded"}),
        (_stale_completion, "complete_lease", {"state", "recorded"}),
        (_stale_acknowledgement, "acknowledge_labels", {"state"}),
        (_late_renewal, "renew_lease", {"outcome"}),
        (_invalid_request, "acknowledge_labels", {"errors"}),
    ],
)
def test_what_a_problem_tells_is_in_the_document(document, work, ask, operation_id, own) -> None:
    answer = ask(work)
    assert set(answer.json()) == {"type", "title", "status", "detail"} | own
    assert set(answer.json()) <= _declared(document, operation_id, answer.status_code)


def test_no_other_problem_has_members_of_its_own() -> None:
    """Whoever raises one with others adds it to those above."""
    raised = {}
    for path in sorted(SERVICE.rglob("*.py")):
        calls = [each for each in ast.walk(ast.parse(path.read_text())) if isinstance(each, ast.Call)]
        names = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "ProblemError"]
        extended = [c for c in names if len(c.args) > 2 or any(k.arg == "extensions" for k in c.keywords)]
        if extended:
            raised[path.name] = len(extended)
    assert raised == {"drafts.py": 1, "leases.py": 1}


def test_a_stroke_is_told_by_its_kind(document) -> None:
    schemas = document["components"]["schemas"]
    assert schemas["Strokes"]["properties"]["strokes"]["items"] == {"$ref": "#/components/schemas/Stroke"}
    assert schemas["StrokeOut"]["properties"]["payload"]["$ref"] == "#/components/schemas/Stroke"
    assert schemas["Stroke"]["discriminator"]["propertyName"] == "kind"
    assert len(schemas["Stroke"]["oneOf"]) == 7


@pytest.mark.parametrize("name", ["v1", "v1_without_steps"])
def test_strokes_that_are_read_are_as_the_document_tells(name) -> None:
    for stroke in json.loads((GOLDEN / f"{name}.json").read_text())["log"]["strokes"]:
        assert Stroke.model_validate_json(json.dumps(stroke)).model_dump(mode="json").keys() == stroke.keys()
        for key in stroke:
            short = {kept: value for kept, value in stroke.items() if kept != key}
            with pytest.raises(ValidationError):
                Stroke.model_validate(short)
            with pytest.raises(FileFormatError):
                stroke_from_document(short)


def test_drafts_tell_their_tag_and_arrays_take_it_back(document) -> None:
    for operation_id in ("open_draft", "show_draft", "show_last_draft", "list_strokes", "append_strokes"):
        assert _operation(document, operation_id)["responses"]["200"]["headers"]["ETag"]["required"], operation_id
    for operation_id in ("get_mesh", "get_labels", "get_uncertainty", "get_thumbnail", "get_draft_labels"):
        operation = _operation(document, operation_id)
        assert "If-None-Match" in [each["name"] for each in operation["parameters"]], operation_id
        assert all("ETag" in operation["responses"][status]["headers"] for status in ("200", "304")), operation_id


@pytest.mark.parametrize("status", [429, 503])
def test_who_has_to_wait_is_told_how_long(document, status) -> None:
    assert "Retry-After" in document["components"]["responses"][f"Problem{status}"]["headers"]


def test_the_service_loads_nothing_heavy() -> None:
    program = "import sys, partwise_service.app; print(*{name.partition('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert HEAVY.isdisjoint(loaded)
