"""Part colours that stay apart for colour-blind eyes."""

import numpy as np
from jaxtyping import Int, UInt8

UNLABELLED_COLOUR = (190, 190, 190)

# The first seven are Okabe and Ito's without black, in an order that keeps neighbours apart. Each later one was chosen
# as far as possible, in CIELAB and under simulated protanopia, deuteranopia and tritanopia, from grey and all before.
_PART_COLOURS = (
    (0, 114, 178),
    (230, 159, 0),
    (0, 158, 115),
    (204, 121, 167),
    (86, 180, 233),
    (213, 94, 0),
    (240, 228, 66),
    (130, 20, 240),
    (90, 40, 0),
    (68, 51, 85),
    (40, 240, 140),
    (0, 34, 170),
    (215, 20, 75),
    (187, 85, 255),
    (187, 221, 255),
    (102, 0, 119),
)
N_PART_COLOURS = len(_PART_COLOURS)


def part_colour(index: int) -> tuple[int, int, int]:
    """sRGB bytes of the index-th part of a collection; grey where negative, repeating after 16."""
    return UNLABELLED_COLOUR if index < 0 else _PART_COLOURS[index % N_PART_COLOURS]


def colours_of_labels(labels: Int[np.ndarray, " m"]) -> UInt8[np.ndarray, "m 3"]:
    """sRGB colour of each label, (m, 3) uint8: `part_colour` of every entry. Labels are part indices, negative
    for none.

    Source: Okabe & Ito 2008. Differs: extended to 16.
    """
    table = np.array([UNLABELLED_COLOUR, *_PART_COLOURS], dtype=np.uint8)
    return table[np.where(labels < 0, 0, labels % N_PART_COLOURS + 1)]
