"""What stands beside ShapeNetPart's points: which folder is which category, and which shapes train, validate and test.

```
synsetoffset2category.txt                                 Chair<tab>03001627, a line for each category
train_test_split/shuffled_{train,val,test}_file_list.json ["shape_data/03001627/<id>", …]
03001627/<id>.txt                                         x y z nx ny nz label
```

Source: `ShapeNetDataLoader.py` of yanx27/Pointnet_Pointnet2_pytorch, which reads these and nothing else. Differs:
nothing.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from partwise.errors import FileFormatError, ParameterError
from partwise.exchange.described_json import load_json
from partwise.exchange.label_files import read_label_text
from partwise.io.atomic import write_atomically

CATEGORY_FILE = "synsetoffset2category.txt"
SPLITS = ("train", "val", "test")
_PREFIX = "shape_data"
_PLAIN_NAME = re.compile(r"(?!\.)[^\s/\\\x00]+")  # what the loaders split at whitespace and slashes


@dataclass(frozen=True, slots=True)
class ShapeNetIndex:
    """categories : name → folder. splits : train, val and test → (folder, shape id) of each shape, in order.

    Raises
    ------
    ParameterError : a name that the files could not hold, an unknown split or folder, or a shape in two splits.
    """

    categories: Mapping[str, str]
    splits: Mapping[str, tuple[tuple[str, str], ...]]

    def __post_init__(self) -> None:
        if strangers := set(self.splits) - set(SPLITS):
            raise ParameterError(f"splits are {SPLITS} but one is {sorted(strangers)[0]!r}; rename it")
        object.__setattr__(self, "categories", MappingProxyType(dict(self.categories)))
        object.__setattr__(self, "splits", MappingProxyType({name: self.splits.get(name, ()) for name in SPLITS}))
        shapes = [shape for name in SPLITS for shape in self.splits[name]]
        names = [*self.categories.keys(), *self.categories.values(), *(part for shape in shapes for part in shape)]
        for name in names:
            if not _PLAIN_NAME.fullmatch(name):
                raise ParameterError(f"names must be without spaces, slashes and leading dots but one is {name!r}")
        if len(set(shapes)) < len(shapes):
            twice = next(shape for shape in shapes if shapes.count(shape) > 1)
            raise ParameterError(f"a shape must be in one split but {'/'.join(twice)} is in more; choose one")
        for folder, shape in shapes:
            if folder not in self.categories.values():
                raise ParameterError(f"a folder must be a category's but {folder!r} of {shape} is none; add it")


def write_shapenet_index(folder: Path | str, index: ShapeNetIndex) -> tuple[Path, ...]:
    """Writes the category file and the three lists, and says where; StoreError if they cannot be written."""
    lines = "".join(f"{name}\t{place}\n" for name, place in index.categories.items())
    contents = {Path(folder) / CATEGORY_FILE: lines}
    for split in SPLITS:
        entries = [f"{_PREFIX}/{place}/{shape}" for place, shape in index.splits[split]]
        contents[_list_path(folder, split)] = json.dumps(entries, ensure_ascii=False) + "\n"
    for path, text in contents.items():
        write_atomically(path, text.encode())
    return tuple(contents)


def read_shapenet_index(folder: Path | str) -> ShapeNetIndex:
    """What a folder of ShapeNetPart says about itself.

    Raises
    ------
    FileFormatError : a file is missing or not as above, or they contradict each other.
    """
    path = Path(folder) / CATEGORY_FILE
    rows = [line.split() for line in read_label_text(path, None).splitlines() if line.strip()]
    if any(len(row) != 2 for row in rows) or len({row[0] for row in rows}) < len(rows):
        raise FileFormatError(f"{path}: lines must be a category's name, once, and its folder but are not; correct it")
    try:
        splits = {split: _read_list(_list_path(folder, split)) for split in SPLITS}
        return ShapeNetIndex(dict(rows), splits)
    except ParameterError as error:
        raise FileFormatError(f"{folder}: {error}") from error


def _list_path(folder: Path | str, split: str) -> Path:
    return Path(folder) / "train_test_split" / f"shuffled_{split}_file_list.json"


def _read_list(path: Path) -> tuple[tuple[str, str], ...]:
    entries = load_json(read_label_text(path, None), f"{path}: the list")
    if not isinstance(entries, list) or not all(isinstance(entry, str) for entry in entries):
        raise FileFormatError(f"{path}: the list must hold texts but does not; is it another file?")
    rows = [entry.split("/") for entry in entries]
    for row, entry in zip(rows, entries, strict=True):
        if len(row) != 3:
            raise FileFormatError(
                f"{path}: an entry must be {_PREFIX}/<folder>/<shape> but is {entry[:80]!r}; correct it"
            )
    return tuple((row[1], row[2]) for row in rows)
