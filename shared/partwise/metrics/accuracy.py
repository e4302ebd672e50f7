"""Share of a shape that is labelled right, by faces and by area."""

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, NotEnoughDataError
from partwise.unlabelled import NO_CLASS


def accuracy(predicted: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"]) -> float:
    """Share of faces with a true label whose predicted label equals it, in [0, 1].

    Faces whose truth is −1 do not count. A prediction of −1 on a labelled face is wrong.

    Raises
    ------
    LabelError : the arrays differ in length.
    NotEnoughDataError : no face has a true label.
    """
    return weighted_accuracy(predicted, truth, np.ones(truth.shape))


def accuracy_by_area(
    predicted: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"], areas: Float[np.ndarray, " m"]
) -> float:
    """As `accuracy`, each face counting by its area (any unit): independent of how finely a part is meshed.

    Raises
    ------
    LabelError : the arrays differ in length, or an area is negative or not finite.
    NotEnoughDataError : the faces with a true label have no area.
    """
    return weighted_accuracy(predicted, truth, areas)


def weighted_accuracy(
    predicted: Int[np.ndarray, " m"], truth: Int[np.ndarray, " m"], weights: Float[np.ndarray, " m"]
) -> float:
    """Share of the weight of labelled faces that is right, in [0, 1]. Raises as `accuracy_by_area` does."""
    check_comparable(predicted, truth, weights)
    counted = np.where(truth == NO_CLASS, 0.0, weights)
    total = float(counted.sum())
    if not total > 0:
        raise NotEnoughDataError("accuracy needs faces with a true label and area but there are none; label some first")
    return float(np.where(predicted == truth, counted, 0.0).sum() / total)


def check_comparable(predicted: np.ndarray, truth: np.ndarray, weights: np.ndarray) -> None:
    """Raises LabelError unless the arrays have one value a face and the weights are finite and ≥ 0."""
    if predicted.ndim != 1 or not predicted.shape == truth.shape == weights.shape:
        raise LabelError(
            f"predicted, truth and weights must have one value a face but are {predicted.shape}, {truth.shape} and "
            f"{weights.shape}; are they of one mesh?"
        )
    if not np.isfinite(weights).all() or (weights < 0).any():
        raise LabelError("weights must be finite and ≥ 0 but some are not; compute areas from a valid mesh")
