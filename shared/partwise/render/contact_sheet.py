"""Many shaded shapes on one page, with captions and a legend of part colours."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import UInt8
from PIL import Image, ImageDraw, ImageFont

from partwise.errors import ParameterError, StoreError
from partwise.mesh import TriMesh
from partwise.render.shaded import THREE_QUARTER, UpAxis, shaded_view

INK, FAINT_INK, PAPER = (35, 35, 40), (110, 110, 118), (255, 255, 255)
PADDING = 14  # pixels around tiles and text
CAPTION_SIZE, TITLE_SIZE = 14, 22  # pixels
LINE_HEIGHT = 1.35  # of the text's size
SWATCH = 14  # pixels


@dataclass(frozen=True, slots=True, eq=False)
class Tile:
    """A shape on the sheet: face_colours (m, 3) uint8 sRGB; caption lines, the first in dark ink, cut to fit."""

    mesh: TriMesh
    face_colours: UInt8[np.ndarray, "m 3"]
    caption: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """A part's name and its sRGB colour."""

    name: str
    colour: tuple[int, int, int]


def contact_sheet(
    tiles: Sequence[Tile],
    columns: int,
    tile_size: int = 300,
    title: str = "",
    legend: Sequence[LegendEntry] = (),
    direction: Sequence[float] = THREE_QUARTER,
    up: UpAxis = "y",
) -> UInt8[np.ndarray, "h w 3"]:
    """Page of shaded shapes, row by row, (h, w, 3) uint8 sRGB on white.

    Parameters
    ----------
    tiles : at least one. columns : ≥ 1. tile_size : side of each picture in pixels, ≥ 32.
    title, legend : above the pictures; left out where empty.
    direction, up : the camera, as for `partwise.render.shaded.shade`.

    Raises
    ------
    ParameterError : no tiles, or a parameter out of range.
    """
    if not tiles or columns < 1 or tile_size < 32:
        raise ParameterError(
            f"a sheet needs tiles, columns ≥ 1 and tile_size ≥ 32 but has {len(tiles)}, {columns} and {tile_size}; "
            "pass at least one shape"
        )
    n_columns = min(columns, len(tiles))
    width = n_columns * (tile_size + PADDING) + PADDING
    header = _header(width, title, legend)
    cell_height = tile_size + _text_height(max(len(tile.caption) for tile in tiles)) + PADDING
    n_rows = -(-len(tiles) // n_columns)
    page = Image.new("RGB", (width, header.height + n_rows * cell_height + PADDING), PAPER)
    page.paste(header, (0, 0))
    for k, tile in enumerate(tiles):
        left = PADDING + (k % n_columns) * (tile_size + PADDING)
        top = header.height + PADDING + (k // n_columns) * cell_height
        picture = shaded_view(tile.mesh, tile.face_colours, (tile_size, tile_size), direction, up)
        page.paste(Image.fromarray(picture), (left, top))
        _write_caption(ImageDraw.Draw(page), tile.caption, (left, top + tile_size), tile_size)
    return np.asarray(page)


def save_png(picture: UInt8[np.ndarray, "h w c"], path: Path) -> None:
    """Write an (h, w, 3) RGB or (h, w, 4) RGBA picture as PNG; the file appears whole or not at all.

    Raises
    ------
    StoreError : the file cannot be written.
    """
    partial = path.with_name(f".{path.name}.partial-{os.getpid()}")
    try:
        Image.fromarray(picture).save(partial, format="PNG", optimize=True)
        partial.replace(path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise StoreError(
            f"the picture {path} must be writable but: {error}; free space or choose another folder"
        ) from error


def _header(width: int, title: str, legend: Sequence[LegendEntry]) -> Image.Image:
    """Title and legend on a strip of the page's width; of no height where both are empty."""
    rows = _legend_rows(width, legend)
    height = (PADDING + round(TITLE_SIZE * LINE_HEIGHT) if title else 0) + (PADDING // 2 if rows else 0)
    legend_top = height
    strip = Image.new("RGB", (width, height + _text_height(len(rows))), PAPER)
    draw = ImageDraw.Draw(strip)
    draw.text((PADDING, PADDING), _fitted(title, width - 2 * PADDING, TITLE_SIZE), INK, font=_font(TITLE_SIZE))
    for k, row in enumerate(rows):
        top = legend_top + _text_height(k)
        for left, entry in row:
            draw.rounded_rectangle((left, top + 2, left + SWATCH, top + 2 + SWATCH), 3, fill=entry.colour)
            draw.text((left + SWATCH + 6, top), entry.name, INK, font=_font(CAPTION_SIZE))
    return strip


def _legend_rows(width: int, legend: Sequence[LegendEntry]) -> list[list[tuple[int, LegendEntry]]]:
    """Entries with their left edges, broken into rows that fit the width."""
    rows: list[list[tuple[int, LegendEntry]]] = []
    left = width
    for entry in legend:
        advance = SWATCH + 6 + round(_font(CAPTION_SIZE).getlength(entry.name)) + 2 * PADDING
        if left + advance > width:
            rows.append([])
            left = PADDING
        rows[-1].append((left, entry))
        left += advance
    return rows


def _write_caption(draw: ImageDraw.ImageDraw, caption: Sequence[str], corner: tuple[int, int], width: int) -> None:
    font = _font(CAPTION_SIZE)
    for k, line in enumerate(caption):
        text = _fitted(line, width, CAPTION_SIZE)
        left = corner[0] + (width - font.getlength(text)) / 2
        draw.text((left, corner[1] + _text_height(k)), text, FAINT_INK if k else INK, font=font)


def _fitted(text: str, width: int, size: int) -> str:
    """The text, cut with an ellipsis where it is wider than width pixels."""
    font = _font(size)
    if font.getlength(text) <= width:
        return text
    while text and font.getlength(text + "…") > width:
        text = text[:-1]
    return text + "…"


def _text_height(n_lines: int) -> int:
    return n_lines * round(CAPTION_SIZE * LINE_HEIGHT)


def _font(size: int) -> "ImageFont.FreeTypeFont | ImageFont.ImageFont":
    return ImageFont.load_default(size)  # Pillow's own, so that pages look the same everywhere
