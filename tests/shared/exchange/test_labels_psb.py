"""`_labels.txt`: 1-based ids under part names."""

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.labels_psb import read_psb_labels, write_psb_labels
from partwise.exchange.named_labels import NamedLabels

DATA = os.environ.get("PARTWISE_DATA")


def read(text, n_faces=6):
    return read_psb_labels("chair_labels.txt", n_faces, text.encode())


@pytest.mark.parametrize(
    "text",
    [
        "seat\n1 2 3\nback rest\n6 5\n",
        "seat\r\n1 2 3 \r\nback rest\r\n6 5",
        "\n seat \n1 2 3\n\nback rest\n5\t6\n\n",
        "\ufeffseat\n1 2\nback rest\n5 6\nseat\n3\n",
    ],
)
def test_reads(text):
    labels = read(text)
    assert labels.part_names == ("seat", "back rest")
    assert labels.indices.tolist() == [0, 0, 0, -1, 1, 1]


def test_a_part_may_list_no_faces():
    labels = read("seat\n\nback\n1 2")
    assert labels.part_names == ("seat", "back")
    assert labels.indices.tolist() == [1, 1, -1, -1, -1, -1]


def test_a_name_at_the_end_lists_no_faces():
    assert read("seat\n1 2\nback").part_names == ("seat", "back")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("seat\n0 1\n", "line 2 names face 0 but ids run from 1 to 6"),
        ("seat\n1 7\n", "names face 7"),
        ("seat\n1 -2\n", "names face -2"),
        ("seat\n1 2 1\n", "lists face 1 twice"),
        (f"seat\n{2**64}\n", "whole numbers"),
        (f"seat\n{'9' * 5000}\n", "whole numbers"),
        ("seat\n1 2\nback\n3 2\n", "line 4 lists face 2 as 'back' but it is 'seat' already"),
        ("seat\n1 2\n3 4\n", "line 3 must be a part name but is '3 4'"),
        ("seat\nback\n1 2\n", "line 2 must hold face ids but has 'back'"),
        ("seat\n1.5\n", "must hold face ids"),
        ("1 2 3\n", "line 1 must be a part name"),
    ],
)
def test_refuses(text, message):
    with pytest.raises(LabelError, match=message) as caught:
        read(text)
    assert str(caught.value).startswith("chair_labels.txt: ")


@pytest.mark.parametrize("data", [b"", b" \n", b"\xff\xfe\x00"])
def test_refuses_what_is_no_text(data):
    with pytest.raises(FileFormatError, match=r"^a_labels\.txt: "):
        read_psb_labels("a_labels.txt", 3, data)


def test_a_missing_file(tmp_path):
    with pytest.raises(FileFormatError, match="No such file"):
        read_psb_labels(tmp_path / "a_labels.txt", 3)


NAMES = st.lists(st.sampled_from(["seat", "back rest", "leg2", "Arm", "été"]), min_size=1, unique=True)


@given(
    NAMES.flatmap(
        lambda names: st.tuples(
            st.just(tuple(names)), arrays.arrays(np.int64, st.integers(1, 30), elements=st.integers(-1, len(names) - 1))
        )
    )
)
@settings(max_examples=40, deadline=None)
def test_round_trip(tmp_path_factory, names_and_indices):
    labels = NamedLabels(*names_and_indices)
    path = tmp_path_factory.mktemp("labels") / "a_labels.txt"
    write_psb_labels(path, labels)
    again = read_psb_labels(path, len(labels.indices))
    assert again.part_names == labels.part_names
    np.testing.assert_array_equal(again.indices, labels.indices)


@pytest.mark.parametrize("name", ["two\nlines", "2", "-3 legs", " seat", "seat "])
def test_names_that_could_not_be_read_back_are_not_written(name, tmp_path):
    with pytest.raises(LabelError, match="one line that starts with a word"):
        write_psb_labels(tmp_path / "a_labels.txt", NamedLabels((name,), np.zeros(2, dtype=np.int64)))
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not DATA, reason="PARTWISE_DATA is not set: no real labels at hand")
def test_every_face_of_the_benchmark_has_a_label():
    files = sorted(Path(DATA).glob("lpsb/*/*_labels.txt"))
    assert len(files) == 200
    for path in files:
        with path.with_name(path.name.replace("_labels.txt", ".off")).open() as mesh:
            n_faces = int(mesh.read(40).split()[2])
        assert read_psb_labels(path, n_faces).indices.min() == 0, path
