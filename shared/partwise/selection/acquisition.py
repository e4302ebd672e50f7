"""How unsure a model is of a shape, from its class probabilities: the scores that rank what is left to label.

Every score is a mean over faces, so that shapes of different size compare; `*_by_area` weights faces by area, so that a
finely meshed detail does not dominate. Entropies are in nats: 0 for a certain face, ln(c) for a uniform one.
"""

import numpy as np
from jaxtyping import Float

from partwise.errors import ParameterError

# float16 rounds each of c probabilities by up to 2⁻¹², so a sum of stored values may be off by this much.
SUM_TOLERANCE = 0.02


def face_entropy(probabilities: Float[np.ndarray, "m c"]) -> Float[np.ndarray, " m"]:
    """Entropy of each face's class distribution.

    Parameters
    ----------
    probabilities : (m, c) any float type, ≥ 0, rows sum to 1 up to rounding (they are renormalised).

    Returns
    -------
    (m,) float64, nats, in [0, ln c]; 0·ln 0 is 0.

    Raises
    ------
    ParameterError : wrong shape, no faces or classes, NaN, a negative value, or a row that does not sum to 1.
    """
    if probabilities.ndim != 2:
        raise ParameterError(f"probabilities must be (faces, classes) but are {probabilities.shape}; index one shape")
    return _entropy(_normalised(probabilities))


def mean_entropy(probabilities: Float[np.ndarray, "m c"]) -> float:
    """Mean of `face_entropy` over faces, nats in [0, ln c]. Same input and errors.

    Source: George, Xie, Lai, Tam 2018.
    """
    return float(face_entropy(probabilities).mean())


def mean_entropy_by_area(probabilities: Float[np.ndarray, "m c"], areas: Float[np.ndarray, " m"]) -> float:
    """Mean of `face_entropy` over the surface, nats in [0, ln c].

    Parameters
    ----------
    probabilities : as for `face_entropy`. areas : (m,) ≥ 0, any unit.

    Raises
    ------
    ParameterError : as `face_entropy`; or areas of another length, negative, not finite, or summing to 0.
    """
    return _mean_by_area(face_entropy(probabilities), areas)


def face_bald(snapshots: Float[np.ndarray, "s m c"]) -> Float[np.ndarray, " m"]:
    """Mutual information of a face's label and the choice of snapshot: entropy of the mean minus mean of entropies.

    High where snapshots are each sure and disagree, 0 where they agree, however unsure they are.

    Parameters
    ----------
    snapshots : (s, m, c) any float type, probabilities of s models as for `face_entropy`.

    Returns
    -------
    (m,) float64, nats, in [0, min(ln c, ln s)].

    Raises
    ------
    ParameterError : as for `face_entropy`, for (s, m, c) arrays.

    Source: Houlsby, Huszár, Ghahramani, Lengyel 2011.
    """
    distributions = _normalised_snapshots(snapshots)
    information = _entropy(distributions.mean(axis=0)) - _entropy(distributions).mean(axis=0)
    return np.maximum(information, 0.0)  # it is ≥ 0 but for rounding


def mean_bald(snapshots: Float[np.ndarray, "s m c"]) -> float:
    """Mean of `face_bald` over faces, nats. Same input and errors."""
    return float(face_bald(snapshots).mean())


def mean_bald_by_area(snapshots: Float[np.ndarray, "s m c"], areas: Float[np.ndarray, " m"]) -> float:
    """Mean of `face_bald` over the surface, nats. Errors: as `face_bald`, and of areas as `mean_entropy_by_area`."""
    return _mean_by_area(face_bald(snapshots), areas)


def face_variation_ratio(snapshots: Float[np.ndarray, "s m c"]) -> Float[np.ndarray, " m"]:
    """Share of snapshots that vote for another label than the one with most votes.

    A snapshot votes for its most probable class (the lower id where two tie).

    Parameters
    ----------
    snapshots : as for `face_bald`.

    Returns
    -------
    (m,) float64 in [0, 1 − 1/min(s, c)]. Dimensionless.

    Raises
    ------
    ParameterError : as for `face_bald`.

    Source: Freeman 1965.
    """
    n_classes = snapshots.shape[-1]
    votes = _normalised_snapshots(snapshots).argmax(axis=2)
    most_votes = np.stack([(votes == label).sum(axis=0) for label in range(n_classes)]).max(axis=0)
    return 1.0 - most_votes / len(votes)


def mean_variation_ratio(snapshots: Float[np.ndarray, "s m c"]) -> float:
    """Mean of `face_variation_ratio` over faces. Same input and errors."""
    return float(face_variation_ratio(snapshots).mean())


def mean_variation_ratio_by_area(snapshots: Float[np.ndarray, "s m c"], areas: Float[np.ndarray, " m"]) -> float:
    """Mean of `face_variation_ratio` over the surface. Errors: as it, and of areas as `mean_entropy_by_area`."""
    return _mean_by_area(face_variation_ratio(snapshots), areas)


def _entropy(distributions: np.ndarray) -> np.ndarray:
    """Entropy over the last axis, nats."""
    logarithms = np.log(distributions, out=np.zeros_like(distributions), where=distributions > 0)
    return np.maximum(-(distributions * logarithms).sum(axis=-1), 0.0)  # turns −0.0 into 0.0


def _normalised_snapshots(snapshots: np.ndarray) -> np.ndarray:
    if snapshots.ndim != 3:
        raise ParameterError(f"snapshots must be (models, faces, classes) but are {snapshots.shape}; stack the models")
    return _normalised(snapshots)


def _normalised(probabilities: np.ndarray) -> np.ndarray:
    """float64 copy with rows that sum to 1; see `face_entropy` for what is refused."""
    if probabilities.size == 0:
        raise ParameterError(f"probabilities must not be empty but are {probabilities.shape}; was the shape evaluated?")
    values = probabilities.astype(np.float64)
    sums = values.sum(axis=-1, keepdims=True)
    if not values.min() >= 0:  # NaN fails this too
        raise ParameterError(f"probabilities must be ≥ 0 but contain {values.min()}; apply softmax to logits first")
    worst = float(sums.flat[np.abs(sums - 1.0).argmax()])
    if not abs(worst - 1.0) <= SUM_TOLERANCE:
        raise ParameterError(f"each face's probabilities must sum to 1 but one sums to {worst}; apply softmax first")
    return values / sums


def _mean_by_area(face_values: np.ndarray, areas: np.ndarray) -> float:
    weights = areas.astype(np.float64)
    if weights.shape != face_values.shape:
        raise ParameterError(
            f"there must be one area a face but areas are {weights.shape} for {len(face_values)} faces; "
            "are both from the same mesh?"
        )
    if not (np.isfinite(weights).all() and weights.min() >= 0 and weights.sum() > 0):
        raise ParameterError(
            f"areas must be finite, ≥ 0 and not all 0 but range from {weights.min()} to {weights.max()}; "
            "are the mesh's faces degenerate?"
        )
    return float(face_values @ weights / weights.sum())
