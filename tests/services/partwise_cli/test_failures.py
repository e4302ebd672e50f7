"""What the command line makes of an exception."""

import errno
import sys
from types import ModuleType

import pytest

from partwise import errors
from partwise_cli.failures import FAULT, INPUT_ERROR, STORE_ERROR, Ending, ending_of


@pytest.mark.parametrize(
    "kind",
    [
        errors.MeshError, errors.DegenerateMeshError, errors.FileFormatError, errors.LabelError, errors.ParameterError,
        errors.NotFoundError, errors.ConflictError, errors.NotEnoughDataError,
    ],
)  # fmt: skip
def test_wrong_input_ends_with_its_message_which_is_for_whoever_gave_it(kind: type[Exception]) -> None:
    message = "a must be b but is c; do d"
    assert ending_of(kind(message)) == Ending(INPUT_ERROR, message, is_domain=True)


def test_what_is_wrong_with_the_configuration_is_for_whoever_wrote_it() -> None:
    assert ending_of(errors.ConfigError("/data is no folder")) == Ending(INPUT_ERROR, "/data is no folder")


def test_a_store_out_of_reach_ends_with_a_code_of_its_own() -> None:
    assert ending_of(errors.StoreError("no room")) == Ending(STORE_ERROR, "no room")


def test_ray_out_of_reach_ends_with_the_same_code() -> None:
    assert ending_of(errors.WorkerError("no Ray")) == Ending(STORE_ERROR, "no Ray")


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG])
def test_a_full_disk_that_nobody_foresaw_is_still_one(number: int) -> None:
    ending = ending_of(OSError(number, "…", "/scratch/x"))
    assert (ending.code, ending.is_fault) == (STORE_ERROR, False)
    assert ending.message == "/scratch/x: files need room but the disk is full; free some space and run again"


def test_another_trouble_of_the_system_names_the_file() -> None:
    ending = ending_of(PermissionError(errno.EACCES, "Permission denied", "/root/x"))
    assert (ending.code, ending.is_fault) == (STORE_ERROR, False)
    assert ending.message.startswith("/root/x: must be usable but: Permission denied;")


def test_a_trouble_of_the_system_without_a_file_says_what_it_knows() -> None:
    assert ending_of(OSError("connection reset")).message.startswith("must be usable but: connection reset;")


def test_too_little_memory_has_a_remedy() -> None:
    ending = ending_of(MemoryError())
    assert (ending.code, ending.is_fault) == (FAULT, False)
    assert "n_actors" in ending.message


def test_what_nobody_foresaw_is_a_fault() -> None:
    ending = ending_of(KeyError("colour"))
    assert (ending.code, ending.is_fault) == (FAULT, True)
    assert ending.message.endswith("KeyError: 'colour'")


def test_trouble_of_ray_is_not_a_fault_of_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    exceptions = ModuleType("ray.exceptions")
    exceptions.RayError = type("RayError", (Exception,), {})
    monkeypatch.setitem(sys.modules, "ray.exceptions", exceptions)
    ending = ending_of(exceptions.RayError("The actor died.\n\tclass_name: Packer"))
    assert (ending.code, ending.is_fault) == (STORE_ERROR, False)
    assert "The actor died.;" in ending.message
    assert "Packer" not in ending.message


def test_an_error_of_a_remote_process_counts_as_raised_here() -> None:
    from ray.exceptions import RayTaskError

    cause = errors.StoreError("the array store has no room; free some space")
    raised = RayTaskError("pack", "a long\nremote traceback", cause).as_instanceof_cause()
    assert ending_of(raised) == Ending(STORE_ERROR, "the array store has no room; free some space")
