"""Light-field descriptor: histograms of oriented gradients (HOG) of 20 depth views, 208,080 values a shape.

Stored as uint8; `light_field_distance` compares two. Views come from a `partwise.render.views.DepthRenderer`.
"""

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from partwise.mesh import TriMesh
from partwise.render.views import N_VIEWS, VIEW_SIZE, DepthRenderer

CELL_SIZE = 8
BLOCK_SIZE = 2 * CELL_SIZE
N_ORIENTATIONS = 9
N_BLOCKS = N_VIEWS * (VIEW_SIZE // CELL_SIZE - 1) ** 2
BLOCK_LENGTH = 4 * N_ORIENTATIONS
LIGHT_FIELD_LENGTH = N_BLOCKS * BLOCK_LENGTH  # 208,080

# A block is a non-negative vector of length at most 1, so values lie in [0, 1] and 1 is reached.
QUANTISATION = 255.0


def light_field(mesh: TriMesh, renderer: DepthRenderer) -> UInt8[np.ndarray, " 208080"]:
    """Light-field descriptor of a mesh.

    Returns
    -------
    (208080,) uint8: views × 17 × 17 blocks × 36. A stored value v stands for v/255, so the rounding error is at most
    1/510; blocks, of length at most 1, move by about 0.005.

    Raises
    ------
    DegenerateMeshError : all vertices that faces use coincide.

    Source: Xie, Xu, Liu, Xiong 2014; George, Xie, Lai, Tam 2018. Differs: 208,080 values from 144×144 pixels,
    because no image gives the printed 203,760.
    """
    values = hog_of_views(renderer.depth_views(mesh))
    return np.rint(values * QUANTISATION).clip(0, 255).astype(np.uint8)


def hog_of_views(views: Float32[np.ndarray, "20 144 144"]) -> Float32[np.ndarray, " 208080"]:
    """HOG of nearness images before quantisation, (208080,) float32 in [0, 1].

    9 unsigned orientations, cells of 8×8 pixels, blocks of 2×2 cells one cell apart, L2-Hys. Views are rounded to 8
    bits first, as OpenCV takes them: 0 background, 1 to 255 from the far to the near side of the sphere.

    Source: Dalal & Triggs 2005, OpenCV's implementation (square-root gamma on).
    """
    hog = cv2.HOGDescriptor(
        (VIEW_SIZE, VIEW_SIZE), (BLOCK_SIZE, BLOCK_SIZE), (CELL_SIZE, CELL_SIZE), (CELL_SIZE, CELL_SIZE), N_ORIENTATIONS
    )
    images = np.rint(views * 255.0).astype(np.uint8)
    return np.concatenate([np.asarray(hog.compute(image), dtype=np.float32).ravel() for image in images])


def light_field_distance(a: UInt8[np.ndarray, " d"], b: UInt8[np.ndarray, " d"]) -> float:
    """Root mean square over blocks of the Euclidean distance between two descriptors' blocks.

    0 for equal descriptors, √2 at most. Dimensionless. The two shapes must be oriented alike: no rotation is searched.
    """
    difference = (a.astype(np.float32) - b.astype(np.float32)) / QUANTISATION
    return float(np.sqrt(np.square(difference).sum(dtype=np.float64) * BLOCK_LENGTH / len(difference)))
