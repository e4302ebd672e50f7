"""Colours of parts: as text, as numbers, and those of parts that nobody has coloured yet."""

from partwise.render.palette import part_colour


def default_colour(part_id: int) -> str:
    """`#RRGGBB`, colour-blind safe, the same for the same id; grey for 0, which is unlabelled."""
    red, green, blue = part_colour(part_id - 1)
    return f"#{red:02X}{green:02X}{blue:02X}"


def rgb(colour: str) -> tuple[int, int, int]:
    """`#E69F00` as (230, 159, 0)."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue
