"""Names in the staging area."""

import pytest

from partwise_workers.tasks import StagedName


def test_a_staged_name_is_read_back() -> None:
    name = StagedName("describe", 17, "ab" * 32)
    assert StagedName.parse(str(name)) == name


@pytest.mark.parametrize("other", ["probe", "probe/abc", "first/a-b", "first/12", "12-key"])
def test_other_names_are_told_apart(other: str) -> None:
    assert StagedName.parse(other) is None
