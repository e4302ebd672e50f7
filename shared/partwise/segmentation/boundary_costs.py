"""The two terms of boundary refinement: what leaving a label costs a face, and what a cut costs an edge.

Each comes in Partwise's form and in the paper's; `BoundaryParameters.form` says which.
"""

import numpy as np
from jaxtyping import Float, Int

from partwise.segmentation.creases import Creases
from partwise.segmentation.parameters import BoundaryParameters
from partwise.unlabelled import NO_CLASS


def leaving_costs(
    anchor: Int[np.ndarray, " m"],
    distances: Float[np.ndarray, "m L"],
    areas: Float[np.ndarray, " m"],
    parameters: BoundaryParameters,
) -> Float[np.ndarray, "m L"]:
    """D(f, l), ≥ 0; 0 for every l where the anchor is −1.

    anchor : (m,) int64, the class to stay near. distances : of each face from each class's boundary, areas : of faces,
    both in units of the diagonal.

    Partwise: 0 for the own class, else (κ + (1 − κ)·min(d/σ, 1))·A_f/σ: an area over the band's width, a length.
    Paper: 0.5 within σ of the boundary of l, else 0 for the own class and 1 for others.
    """
    own = anchor[:, None] == np.arange(distances.shape[1])
    if parameters.form == "paper":
        cost = np.where(distances <= parameters.band, 0.5, np.where(own, 0.0, 1.0))
    else:
        least = parameters.least_move_cost
        share = np.minimum(distances / parameters.band, 1.0)
        cost = np.where(own, 0.0, least + (1.0 - least) * share) * (areas / parameters.band)[:, None]
    return np.where(anchor[:, None] == NO_CLASS, 0.0, cost)


def cut_costs(
    creases: Creases, lengths: Float[np.ndarray, " k"], parameters: BoundaryParameters
) -> Float[np.ndarray, " k"]:
    """λ·φ_S of each edge, ≥ 0. lengths : of the edges, in units of the diagonal.

    Partwise: −log P·|e|, scaled to be |e| where there is no sign of a crease; P = 1/(1 + exp(flatness − strength)) is a
    logistic model of the edge being a boundary, with `crease_strength`.
    Paper: −log max(floor, (ω·a + (1−ω)·δ)/(ω·π + 1 − ω))·|e|/mean|e|.
    """
    if parameters.form == "paper":
        mean = float(lengths.mean()) if lengths.any() else 1.0
        return parameters.smoothness * _paper_dissimilarity(creases, parameters) * (lengths / mean)
    surprise = np.logaddexp(0.0, parameters.flatness - crease_strength(creases, parameters))
    return parameters.smoothness * surprise / np.logaddexp(0.0, parameters.flatness) * lengths


def crease_strength(creases: Creases, parameters: BoundaryParameters) -> Float[np.ndarray, " k"]:
    """Evidence for a boundary at each edge: concave creases and changes of diameter for it, convex creases against.

    ω between 0.5 and 1 fades the diameter out, between 0.5 and 0 the angles.
    """
    omega = parameters.angle_weight if creases.has_diameter else 1.0
    concave = np.maximum(creases.angles, 0.0) + np.maximum(creases.bends, 0.0)
    convex = np.maximum(-creases.angles, 0.0) + np.maximum(-creases.bends, 0.0)
    by_angle = parameters.concave_gain * concave - parameters.convex_gain * convex
    by_diameter = parameters.diameter_gain * creases.diameter_slopes
    return min(1.0, 2 * omega) * by_angle + min(1.0, 2 * (1 - omega)) * by_diameter


def _paper_dissimilarity(creases: Creases, parameters: BoundaryParameters) -> Float[np.ndarray, " k"]:
    omega = parameters.angle_weight if creases.has_diameter else 1.0
    reached = omega * np.abs(creases.angles) + (1 - omega) * creases.diameter_jumps
    return -np.log(np.clip(reached / (omega * np.pi + (1 - omega)), parameters.angle_floor, 1.0))
