"""`<id>_labels.txt` of the Princeton benchmark: a part name line, then a line of 1-based face ids, repeated."""

from pathlib import Path

import numpy as np
from jaxtyping import Int

from partwise.errors import FileFormatError, LabelError
from partwise.exchange.label_files import read_label_text
from partwise.exchange.named_labels import NamedLabels
from partwise.io.atomic import write_atomically
from partwise.io.text import parse_integers
from partwise.unlabelled import NO_CLASS


def read_psb_labels(path: Path | str, n_faces: int, data: bytes | None = None) -> NamedLabels:
    """Labels of a mesh with `n_faces` faces. Faces that no part lists stay unlabelled; a part may list none.

    Parts differ between the shapes of a category: map them with `to_part_ids`.

    Raises
    ------
    FileFormatError : missing, empty or not text.
    LabelError : a face id outside 1 … n_faces, a face listed twice, a line that is neither; says the line.
    """
    text = read_label_text(path, data)
    indices = np.full(n_faces, NO_CLASS, dtype=np.int64)
    names: list[str] = []
    lines = iter(enumerate(text.splitlines(), start=1))
    for number, line in lines:
        name = line.strip()
        if not name:
            continue
        if _is_number(name.split()[0]):
            raise LabelError(
                f"{path}: line {number} must be a part name but is {name[:40]!r}; ids of a part go on one line"
            )
        number, ids_line = next(lines, (number, ""))
        faces = _face_ids(ids_line, f"{path}: line {number}", n_faces)
        taken = indices[faces] != NO_CLASS
        if taken.any():
            face = int(faces[np.argmax(taken)])
            raise LabelError(
                f"{path}: line {number} lists face {face + 1} as {name!r} but it is {names[indices[face]]!r} already; "
                "a face has one part"
            )
        if name not in names:  # a name that comes again adds to its part
            names.append(name)
        indices[faces] = names.index(name)
    return NamedLabels(tuple(names), indices)


def write_psb_labels(path: Path | str, labels: NamedLabels) -> None:
    """Writes labels so that `read_psb_labels` gives them back. Unlabelled faces are in no list.

    Raises
    ------
    LabelError : a part name spans lines, starts with a number or has spaces at its ends: the format could not hold it.
    StoreError : the file cannot be written.
    """
    lines: list[str] = []
    for k, name in enumerate(labels.part_names):
        if name != name.strip() or len(name.splitlines()) != 1 or _is_number(name.split()[0]):
            raise LabelError(f"{path}: part name {name!r} must be one line that starts with a word; rename the part")
        ids = np.flatnonzero(labels.indices == k) + 1
        lines += [name, " ".join(map(str, ids.tolist()))]
    write_atomically(path, "".join(f"{line}\n" for line in lines).encode())


def _face_ids(line: str, where: str, n_faces: int) -> Int[np.ndarray, " k"]:
    """0-based faces of a line of 1-based ids."""
    tokens = line.split()
    strange = next((token for token in tokens if not _is_number(token)), None)
    if strange is not None:
        raise LabelError(f"{where} must hold face ids but has {strange[:40]!r}; a name line is followed by one of ids")
    try:
        ids = parse_integers([token.encode() for token in tokens], "face ids")
    except FileFormatError as error:
        raise LabelError(f"{where}: {error}") from error
    if len(ids) and (int(ids.min()) < 1 or int(ids.max()) > n_faces):
        bad = int(ids.min()) if int(ids.min()) < 1 else int(ids.max())
        raise LabelError(f"{where} names face {bad} but ids run from 1 to {n_faces}; are the labels another mesh's?")
    distinct, counts = np.unique(ids, return_counts=True)
    if (counts > 1).any():
        raise LabelError(f"{where} lists face {int(distinct[counts > 1][0])} twice; remove one")
    return ids - 1


def _is_number(token: str) -> bool:
    return token.removeprefix("-").isdecimal()
