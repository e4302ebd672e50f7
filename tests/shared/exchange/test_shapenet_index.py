"""ShapeNetPart's category file and lists."""

import json

import pytest

from partwise.errors import FileFormatError, ParameterError
from partwise.exchange.shapenet_index import (
    CATEGORY_FILE,
    ShapeNetIndex,
    read_shapenet_index,
    write_shapenet_index,
)

INDEX = ShapeNetIndex(
    {"Chair": "03001627", "Mug": "03797390"}, {"train": (("03001627", "a"),), "test": (("03797390", "b"),)}
)
TEST_LIST = "train_test_split/shuffled_test_file_list.json"


def test_round_trip(tmp_path):
    written = write_shapenet_index(tmp_path, INDEX)
    assert {path.relative_to(tmp_path).as_posix() for path in written} == {
        CATEGORY_FILE,
        *(f"train_test_split/shuffled_{split}_file_list.json" for split in ("train", "val", "test")),
    }
    again = read_shapenet_index(tmp_path)
    assert dict(again.categories) == dict(INDEX.categories)
    assert dict(again.splits) == {"train": (("03001627", "a"),), "val": (), "test": (("03797390", "b"),)}


def test_as_loaders_read_them(tmp_path):
    write_shapenet_index(tmp_path, INDEX)
    assert (tmp_path / CATEGORY_FILE).read_text().splitlines()[0].split() == ["Chair", "03001627"]
    assert json.loads((tmp_path / TEST_LIST).read_text())[0].split("/")[2] == "b"


@pytest.mark.parametrize(
    ("categories", "splits", "message"),
    [
        ({"Chair": "1"}, {"dev": ()}, "'dev'"),
        ({"Arm Chair": "1"}, {}, "without spaces"),
        ({"Chair": "../1"}, {}, "slashes"),
        ({"Chair": "1"}, {"train": (("1", ".."),)}, "leading dots"),
        ({"Chair": "1"}, {"train": (("1", "a"),), "val": (("1", "a"),)}, "1/a is in more"),
        ({"Chair": "1"}, {"train": (("2", "a"),)}, "'2' of a is none"),
    ],
)
def test_refuses(categories, splits, message):
    with pytest.raises(ParameterError, match=message):
        ShapeNetIndex(categories, splits)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        (CATEGORY_FILE, "Chair\n", "its folder"),
        (CATEGORY_FILE, "Chair 1\nChair 2\n", "once"),
        (CATEGORY_FILE, "Chair 1\n", "is none"),
        (TEST_LIST, "{}", "must hold texts"),
        (TEST_LIST, "[1]", "must hold texts"),
        (TEST_LIST, '["a/b"]', "but is 'a/b'"),
        (TEST_LIST, '["shape_data/03797390', "must be JSON"),
        (TEST_LIST, '["shape_data/../b"]', "leading dots"),
    ],
)
def test_reading_refuses(tmp_path, name, text, message):
    write_shapenet_index(tmp_path, INDEX)
    (tmp_path / name).write_text(text)
    with pytest.raises(FileFormatError, match=message) as caught:
        read_shapenet_index(tmp_path)
    assert str(caught.value).startswith(str(tmp_path))


def test_a_list_is_missing(tmp_path):
    write_shapenet_index(tmp_path, INDEX)
    (tmp_path / TEST_LIST).unlink()
    with pytest.raises(FileFormatError, match="No such file"):
        read_shapenet_index(tmp_path)
