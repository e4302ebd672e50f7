"""The contact sheet of the shapes that the model is least sure of."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from partwise.exchange.ply_labels import colour_faces
from partwise.labels.palette import rgb
from partwise.render.contact_sheet import LegendEntry, Tile, contact_sheet, save_png
from partwise.store.records import Collection, Shape
from partwise.workspace.assessment import ShapeAccuracy
from partwise.workspace.segmentations import Segmentation, segment
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace

COLUMNS = 4


def write_worst_shapes(
    workspace: Workspace,
    collection: Collection,
    ranked: Sequence[Shape],
    accuracies: Sequence[ShapeAccuracy],
    path: Path,
) -> None:
    """Draws the refined labels of the shapes, in order of rank, with their accuracy where it is known."""
    parts = workspace.catalog.parts(collection.id).parts
    colours = {part.id: rgb(part.colour) for part in parts}
    accuracy_of = {accuracy.shape.id: accuracy.by_face for accuracy in accuracies}
    tiles = []
    for rank, segmented in enumerate(segment(workspace, ranked, Segmentation.REFINED), start=1):
        known = accuracy_of.get(segmented.shape.id)
        caption = (f"{rank}. {segmented.shape.source_key}", "" if known is None else f"{known:.1%} of faces right")
        face_colours = colour_faces(segmented.labels.astype(np.int64), colours)
        tiles.append(Tile(load_mesh(workspace, segmented.mesh), face_colours, caption))
    legend = [LegendEntry(part.name, rgb(part.colour)) for part in parts]
    title = f"{collection.name}: the {len(tiles)} shapes the model is least sure of, as refined"
    save_png(contact_sheet(tiles, COLUMNS, title=title, legend=legend, up=collection.settings.get("up", "y")), path)
