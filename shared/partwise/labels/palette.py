"""Default part colours that stay apart for colour-blind eyes: Okabe & Ito's, then Tol's muted ones, then hues."""

import colorsys

_OKABE_ITO = ("#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7")
_TOL_MUTED = ("#332288", "#88CCEE", "#44AA99", "#117733", "#999933", "#DDCC77", "#CC6677", "#882255", "#AA4499")
_GOLDEN_RATIO = 0.618033988749895  # steps of the golden ratio keep any number of hues apart


def default_colour(part_id: int) -> str:
    """Colour of a part nobody has coloured yet, `#RRGGBB`; the same for the same id. Ids start at 1; 0 is grey."""
    if part_id <= 0:
        return "#BBBBBB"
    named = _OKABE_ITO + _TOL_MUTED
    if part_id <= len(named):
        return named[part_id - 1]
    red, green, blue = colorsys.hsv_to_rgb(part_id * _GOLDEN_RATIO % 1.0, 0.55, 0.85)
    return f"#{round(red * 255):02X}{round(green * 255):02X}{round(blue * 255):02X}"
