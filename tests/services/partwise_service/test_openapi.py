"""The document is complete, and what it is made of loads nothing heavy."""

import re
import subprocess
import sys

import pytest

from partwise_service.problems import MEDIA_TYPE, ProblemKind

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


def test_the_service_loads_nothing_heavy() -> None:
    program = "import sys, partwise_service.app; print(*{name.partition('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert HEAVY.isdisjoint(loaded)
