"""The block kinds of the standard stages. Vertices float32, faces uint32, histograms quantised (see `quantise`)."""

from partwise.render.thumbnail import PICTURE_SIZE
from partwise.store.blocks import BlockKind, Domain, Quantity

N_BINS = 256
"""Bins of a shape context or a spin image, 16 × 16."""
N_LIGHT_FIELD = 208_080
"""Values of a light-field descriptor, 20 views × 17² blocks × 36."""

MESH = BlockKind(
    "mesh",
    (Quantity("vertices", Domain.VERTEX, "float32", (3,)), Quantity("faces", Domain.FACE, "uint32", (3,))),
)

REMESH = BlockKind(
    "remesh",
    (
        *MESH.quantities,
        Quantity("level_vertices", Domain.LEVEL_VERTEX, "float32", (3,)),
        Quantity("level_faces", Domain.LEVEL_FACE, "uint32", (3,)),
        Quantity("level_sizes", Domain.SHAPE, "uint32", (None, 3)),
        Quantity("working_level", Domain.SHAPE, "uint32"),
    ),
)
"""The working mesh, and its other resolutions one after the other: see `partwise.store.levels`."""

FEATURES = BlockKind(
    "features",
    (
        Quantity("shape_context", Domain.FACE, "uint8", (N_BINS,)),
        Quantity("shape_context_scale", Domain.SHAPE, "float32"),
        Quantity("spin_image", Domain.FACE, "uint8", (N_BINS,)),
        Quantity("spin_image_scale", Domain.SHAPE, "float32"),
        Quantity("shape_diameter", Domain.FACE, "float32"),
        Quantity("light_field", Domain.SHAPE, "uint8", (N_LIGHT_FIELD,)),
    ),
)

EVALUATION = BlockKind(
    "evaluation",
    (Quantity("probabilities", Domain.FACE, "float16", (None,)), Quantity("part_ids", Domain.SHAPE, "uint16", (None,))),
)
"""Column j of `probabilities` is the part `part_ids[j]`."""

REFINEMENT = BlockKind("refinement", (Quantity("labels", Domain.FACE, "uint16"),))

PICTURE = BlockKind(
    "picture",
    (
        Quantity("face_ids", Domain.SHAPE, "int32", (PICTURE_SIZE, PICTURE_SIZE)),
        Quantity("shading", Domain.SHAPE, "uint8", (PICTURE_SIZE, PICTURE_SIZE)),
    ),
)
"""What thumbnails are coloured from: see `partwise.render.thumbnail`."""
