"""Intersection over union of each part."""

import numpy as np
from jaxtyping import Float, Int

from partwise.errors import LabelError, NotEnoughDataError
from partwise.metrics.accuracy import check_comparable
from partwise.unlabelled import NO_CLASS


def part_iou(
    predicted: Int[np.ndarray, " m"],
    truth: Int[np.ndarray, " m"],
    part_ids: Int[np.ndarray, " p"],
    weights: Float[np.ndarray, " m"],
) -> Float[np.ndarray, " p"]:
    """Weight where both say the part, over weight where either does; (p,) float64 in [0, 1].

    Faces whose truth is −1 do not count. A part that neither names has no value: NaN. One that only one of the two
    names scores 0. Use areas as weights, or ones to count faces.

    Raises
    ------
    LabelError : arrays of different length, weights negative or not finite, or a label that is not in `part_ids`
        (the truth may be −1, and so may predictions).
    """
    check_comparable(predicted, truth, weights)
    known = np.append(part_ids, NO_CLASS)
    for name, labels in (("predicted", predicted), ("truth", truth)):
        strangers = np.setdiff1d(labels, known)
        if len(strangers):
            raise LabelError(
                f"{name} labels must be among {part_ids.tolist()} but hold {int(strangers[0])}; other schema?"
            )
    counted = np.where(truth == NO_CLASS, 0.0, weights)
    is_predicted = predicted[None, :] == part_ids[:, None]
    is_true = truth[None, :] == part_ids[:, None]
    intersection = (is_predicted & is_true) @ counted
    union = (is_predicted | is_true) @ counted
    return np.divide(intersection, union, out=np.full(len(part_ids), np.nan), where=union > 0)


def mean_iou(iou: Float[np.ndarray, " p"]) -> float:
    """Mean over the parts that have a value.

    Raises
    ------
    NotEnoughDataError : no part has a value.

    Source: ShapeNetPart's mIoU. Differs: there a part that neither names scores 1; use `mean_iou_absent_as_one`.
    """
    if np.isnan(iou).all():
        raise NotEnoughDataError("mean IoU needs a part that is present but none is; was anything labelled?")
    return float(np.nanmean(iou))


def mean_iou_absent_as_one(iou: Float[np.ndarray, " p"]) -> float:
    """Mean over all parts, one that neither names scoring 1: the convention of ShapeNetPart (Yi et al. 2016).

    Raises
    ------
    NotEnoughDataError : there are no parts.
    """
    if not len(iou):
        raise NotEnoughDataError("mean IoU needs at least one part but the schema has none; add parts")
    return float(np.where(np.isnan(iou), 1.0, iou).mean())
