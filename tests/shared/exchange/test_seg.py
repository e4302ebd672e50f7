"""`.seg`: one number a face."""

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.seg import read_seg, write_seg

DATA = os.environ.get("PARTWISE_DATA")


@given(arrays.arrays(np.int64, st.integers(1, 50), elements=st.integers(-1, 2**40)))
@settings(max_examples=40, deadline=None)
def test_round_trip(tmp_path_factory, labels):
    path = tmp_path_factory.mktemp("labels") / "a.seg"
    write_seg(path, labels)
    np.testing.assert_array_equal(read_seg(path, len(labels)), labels)


@pytest.mark.parametrize(
    ("data", "error", "message"),
    [
        (b"", FileFormatError, "empty"),
        (b"1\n2\n", LabelError, "3 faces must have a label each but there are 2"),
        (b"1\n2\n3\n4\n", LabelError, "there are 4"),
        (b"1\n-2\n3\n", LabelError, "one is -2"),
        (b"1\n2.5\n3\n", FileFormatError, "whole numbers"),
        (b"1\nseat\n3\n", FileFormatError, "whole numbers"),
    ],
)
def test_refuses(data, error, message):
    with pytest.raises(error, match=message) as caught:
        read_seg("a.seg", 3, data)
    assert str(caught.value).startswith("a.seg: ")
    assert str(caught.value).count("a.seg") == 1


@pytest.mark.parametrize("labels", [np.array([0, -2]), np.zeros((2, 2), dtype=int)])
def test_does_not_write_what_could_not_be_read(labels, tmp_path):
    with pytest.raises(LabelError, match="whole numbers"):
        write_seg(tmp_path / "a.seg", labels)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real labels at hand")
def test_coseg_has_a_label_for_every_face():
    files = sorted(Path(DATA).glob("coseg/*/gt/*.seg"))
    assert len(files) == 14
    for path in files:
        with (path.parents[1] / "shapes" / f"{path.stem}.off").open() as mesh:
            n_faces = int(mesh.read(40).split()[2])
        assert read_seg(path, n_faces).min() >= 0, path
