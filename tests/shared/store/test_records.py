"""Records that check what they are given."""

import pytest

from partwise.errors import ParameterError
from partwise.store.records import NewShape


@pytest.mark.parametrize("key", ["/etc/passwd", "../a.off", "a/../b.off", "a//b.off", "", ".", "a\\b.off", "a\nb.off"])
def test_a_source_key_that_could_leave_the_export_folder_is_refused(key: str) -> None:
    with pytest.raises(ParameterError, match="relative path"):
        NewShape(key, "0" * 64, ".off")


@pytest.mark.parametrize("key", ["a.off", "chairs/a b.off", "a..b.off", "größe.obj"])
def test_a_plain_relative_path_is_taken(key: str) -> None:
    assert NewShape(key, "0" * 64, ".off").source_key == key
