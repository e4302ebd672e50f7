"""A shape's picture in the colours of labels, from the two images that were rendered of its mesh once."""

import numpy as np
from fastapi import Request, Response

from partwise.labels.palette import rgb
from partwise.render.thumbnail import colour_thumbnail
from partwise.store.records import Shape
from partwise.workspace.pictures import find_picture
from partwise.workspace.workspace import Workspace
from partwise_service.array_responses import entity_tag, not_modified, png_response
from partwise_service.shown_labels import ShownLabels


def thumbnail_response(request: Request, workspace: Workspace, shape: Shape, labels: ShownLabels | None) -> Response:
    """A PNG; grey without labels, and where they are of another mesh than the picture.

    Raises
    ------
    NotFoundError : the shape has no picture yet.
    """
    picture = find_picture(workspace, shape)
    if labels is not None and labels.mesh_hash != picture.mesh_hash:
        labels = None
    colours = {part.id: part.colour for part in workspace.catalog.parts(shape.collection_id).parts}
    tag = entity_tag("thumbnail", picture.identity, labels and labels.identity, sorted(colours.items()))
    held = not_modified(request, tag)
    if held is not None:
        return held
    face_ids, shading = picture.read()
    ids = np.zeros(max(int(face_ids.max()) + 1, 1), dtype=np.uint16) if labels is None else labels.read()
    return png_response(colour_thumbnail(face_ids, shading, ids, {k: rgb(v) for k, v in colours.items()}), tag)
