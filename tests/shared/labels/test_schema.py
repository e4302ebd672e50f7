"""Parts, schemas and default colours."""

import pytest

from partwise.errors import LabelError
from partwise.labels.palette import default_colour
from partwise.labels.schema import MAX_PART_ID, Part, PartSchema

_SCHEMA = PartSchema(3, (Part(1, "seat", "#E69F00"), Part(4, "Back", "#56B4E9", "leans"), Part(2, "leg", "#009E73")))


@pytest.mark.parametrize("part_id", [0, -1, MAX_PART_ID + 1])
def test_a_part_id_out_of_range_is_refused(part_id: int) -> None:
    with pytest.raises(LabelError, match="part id must be 1 to 65535"):
        Part(part_id, "seat", "#E69F00")


@pytest.mark.parametrize("name", ["", " ", " seat", "seat\n"])
def test_an_empty_or_padded_name_is_refused(name: str) -> None:
    with pytest.raises(LabelError, match="non-empty"):
        Part(1, name, "#E69F00")


@pytest.mark.parametrize("name", ["a" * 65, "se\x00at", "seat,back"])
def test_a_name_that_cannot_be_written_is_refused(name: str) -> None:
    with pytest.raises(LabelError, match="printable"):
        Part(1, name, "#E69F00")


@pytest.mark.parametrize("colour", ["", "red", "#12345", "#GGGGGG", "#E69F00FF"])
def test_a_malformed_colour_is_refused(colour: str) -> None:
    with pytest.raises(LabelError, match="colour"):
        Part(1, "seat", colour)


def test_a_version_below_one_is_refused() -> None:
    with pytest.raises(LabelError, match="version"):
        PartSchema(0, ())


@pytest.mark.parametrize(
    ("second", "what"), [(Part(2, "seat", "#56B4E9"), "part name"), (Part(1, "back", "#56B4E9"), "part id")]
)
def test_a_name_or_an_id_twice_is_refused(second: Part, what: str) -> None:
    with pytest.raises(LabelError, match=what):
        PartSchema(1, (Part(1, "seat", "#E69F00"), second))


def test_order_is_kept() -> None:
    assert _SCHEMA.ids == (1, 4, 2)
    assert _SCHEMA.names == ("seat", "Back", "leg")


def test_names_and_ids_find_their_part() -> None:
    assert _SCHEMA.id_of("Back") == 4
    assert _SCHEMA.part(4).gloss == "leans"


def test_an_unknown_name_names_the_nearest() -> None:
    with pytest.raises(LabelError, match="'back' is not in schema version 3; did you mean Back"):
        _SCHEMA.id_of("back")


def test_a_name_like_no_other_names_them_all() -> None:
    with pytest.raises(LabelError, match="the parts are: seat, Back, leg"):
        _SCHEMA.id_of("propeller")


def test_an_unknown_id_names_the_known_ones() -> None:
    with pytest.raises(LabelError, match=r"part id 3 is not in schema version 3; it has 1 \(seat\)"):
        _SCHEMA.part(3)


def test_an_empty_schema_says_so() -> None:
    with pytest.raises(LabelError, match="no parts"):
        PartSchema(1, ()).part(1)
    with pytest.raises(LabelError, match="none"):
        PartSchema(1, ()).id_of("seat")


def test_default_colours_differ_and_are_valid() -> None:
    parts = [Part(i, f"part {i}", default_colour(i)) for i in range(1, 17)]
    assert len({part.colour for part in parts}) == 16


def test_unlabelled_is_grey() -> None:
    red, green, blue = (int(default_colour(0)[i : i + 2], 16) for i in (1, 3, 5))
    assert red == green == blue


def _with_parents(*parents: int | None) -> PartSchema:
    """Parts 1, 2, … whose parents are these."""
    names = ("base", "leg", "foot")
    return PartSchema(1, tuple(Part(i, names[i - 1], "#E69F00", "", up) for i, up in enumerate(parents, start=1)))


def test_ancestors_go_up_to_the_top() -> None:
    schema = _with_parents(None, 1, 2)
    assert [schema.ancestors(part_id) for part_id in (1, 2, 3)] == [(), (1,), (2, 1)]


@pytest.mark.parametrize(
    ("parents", "says"),
    [((1,), "base → base"), ((2, 1), "base → leg → base"), ((2, 3, 2), "base → leg → foot → leg"), ((None, 9), "9")],
)
def test_parents_in_a_circle_or_unknown_are_refused(parents: tuple[int | None, ...], says: str) -> None:
    with pytest.raises(LabelError, match=says):
        _with_parents(*parents)
