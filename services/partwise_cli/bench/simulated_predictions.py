"""Predictions as a trained model makes them, without training: right to a stated share, wrong where models are."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, ParameterError
from partwise.geometry.adjacency import edge_adjacency, label_regions
from partwise.geometry.faces import bounding_box_diagonal, face_areas, face_centroids
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy_by_area
from partwise.segmentation.boundary_distances import SurfaceGraph, boundary_distances
from partwise.segmentation.model_refinement import refine
from partwise_cli.bench.displacement import smooth_field

ACCURACY = 0.92
"""Share of the area taken to be right on a held-out shape; `partwise bench loo` measures it for a real model."""
ACCURACY_SPREAD = 0.03
REACH = 0.06
"""Distance from a boundary, in diagonals, from which on a model is as sure as it gets."""
CERTAINTY = 2.5
"""Logit of being that sure."""
WAVELENGTHS = ((0.6, 0.25), (0.25, 0.6), (0.1, 0.5))
"""(length in diagonals, weight) of the noise over the surface: blobs of wrong labels, ragged boundaries."""
SEGMENT_WEIGHT = 0.5
"""Weight of noise that a whole segment shares: a leg taken for an arm."""
SPECKLE_WEIGHT = 0.3
N_STEPS = 30


@dataclass(frozen=True, slots=True, eq=False)
class SimulatedPrediction:
    """probabilities : (m, L). predicted : (m,) int64, their most probable class, refined : after the graph cut."""

    probabilities: Float[np.ndarray, "m L"]
    predicted: Int[np.ndarray, " m"]
    refined: Int[np.ndarray, " m"]


def simulate_prediction(
    mesh: TriMesh, truth: Int[np.ndarray, " m"], n_classes: int, accuracy: float, rng: np.random.Generator
) -> SimulatedPrediction:
    """Probabilities whose most probable class is right on about `accuracy` of the area.

    The logit of a class is its signed distance from the class's true boundary, cut at REACH, plus noise: smooth over
    the surface at several wavelengths, shared by segments, and of each face by itself. The noise is made as strong as
    the accuracy asks for. Classes that the shape lacks come up where noise favours them, as with a model.

    Raises
    ------
    LabelError : not one class in 0 … n_classes − 1 a face.
    ParameterError : an accuracy outside (0, 1].
    """
    if truth.shape != (mesh.n_faces,) or int(truth.min()) < 0 or int(truth.max()) >= n_classes:
        raise LabelError(f"predictions need {mesh.n_faces} true classes in 0 … {n_classes - 1}; label every face first")
    if not 0 < accuracy <= 1:
        raise ParameterError(f"accuracy must be in (0, 1] but is {accuracy}; 0.92 is usual")
    sure, noise = _certainty(mesh, truth, n_classes), _noise(mesh, truth, n_classes, rng)
    areas = face_areas(mesh)
    least, most = 0.0, 64.0
    for _ in range(N_STEPS):
        strength = (least + most) / 2
        if accuracy_by_area(np.argmax(sure + strength * noise, axis=1), truth, areas) >= accuracy:
            least = strength
        else:
            most = strength
    logits = sure + least * noise
    weights = np.exp(logits - logits.max(axis=1, keepdims=True))
    probabilities = weights / weights.sum(axis=1, keepdims=True)
    return SimulatedPrediction(probabilities, np.argmax(logits, axis=1), refine(mesh, probabilities))


def drawn_accuracy(rng: np.random.Generator) -> float:
    """How much is right differs from shape to shape: normal, kept within 0.7 and 0.99."""
    return float(np.clip(rng.normal(ACCURACY, ACCURACY_SPREAD), 0.7, 0.99))


def _certainty(mesh: TriMesh, truth: Int[np.ndarray, " m"], n_classes: int) -> Float[np.ndarray, "m L"]:
    limit = REACH * bounding_box_diagonal(mesh)
    graph = SurfaceGraph.build(mesh, edge_adjacency(mesh))
    distance = np.minimum(boundary_distances(graph, truth, n_classes, limit), limit) / limit
    return CERTAINTY * np.where(truth[:, None] == np.arange(n_classes), distance, -distance)


def _noise(
    mesh: TriMesh, truth: Int[np.ndarray, " m"], n_classes: int, rng: np.random.Generator
) -> Float[np.ndarray, "m L"]:
    points = face_centroids(mesh) / bounding_box_diagonal(mesh)
    segment = label_regions(truth, edge_adjacency(mesh).faces)
    columns = []
    for _ in range(n_classes):
        smooth = sum(weight * smooth_field(points / length, rng) for length, weight in WAVELENGTHS)
        shared = SEGMENT_WEIGHT * rng.standard_normal(int(segment.max()) + 1)[segment]
        columns.append(smooth + shared + SPECKLE_WEIGHT * rng.standard_normal(len(truth)))
    return np.stack(columns, axis=1)
