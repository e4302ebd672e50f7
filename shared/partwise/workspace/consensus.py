"""How close people's labels of a shape are: to each other's, and to a reference."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from jaxtyping import UInt16

from partwise.geometry.faces import face_areas
from partwise.mesh import TriMesh
from partwise.metrics.accuracy import accuracy_by_area
from partwise.metrics.boundary_distance import boundary_distance
from partwise.metrics.iou import mean_iou, part_iou
from partwise.store.records import Closeness, NewConsensus
from partwise.unlabelled import NO_CLASS, NO_PART_ID

Labels = UInt16[np.ndarray, " m"]


def closeness(mesh: TriMesh, labels: Labels, reference: Labels) -> Closeness:
    """How close labels are to reference labels of the same mesh, in the measures by which models are judged.

    Faces that the reference leaves unlabelled do not count; with none labelled, labels that say nothing either agree.
    """
    truth, given = (np.where(each == NO_PART_ID, NO_CLASS, each.astype(np.int64)) for each in (reference, labels))
    if (truth == NO_CLASS).all():
        return _of_nothing(bool((given == NO_CLASS).all()))
    return _measured(mesh, given, truth)


def agreement(mesh: TriMesh, first: Labels, second: Labels) -> Closeness:
    """How close two people's labels are to each other: symmetric. What both leave unlabelled they agree on."""
    return _measured(mesh, first.astype(np.int64), second.astype(np.int64))


def compared(mesh: TriMesh, peers: Sequence[tuple[int, Labels]], own: Labels) -> NewConsensus:
    """What labels come to together with all others of their round.

    peers : (answer id, labels) of the others. The medoid has the highest mean area agreement with the others; of
    equals the earliest. Labels without peers agree with themselves.
    """
    ids: list[int | None] = [*(answer_id for answer_id, _ in peers), None]
    given = [*(labels for _, labels in peers), own]
    pairs = {pair: agreement(mesh, given[pair[0]], given[pair[1]]) for pair in combinations(range(len(given)), 2)}
    if not pairs:
        return NewConsensus((), Closeness(1.0, 1.0, 0.0), None)
    means = [
        float(np.mean([each.area_agreement for pair, each in pairs.items() if place in pair]))
        for place in range(len(given))
    ]
    mean = Closeness(
        float(np.mean([each.area_agreement for each in pairs.values()])),
        float(np.mean([each.part_iou for each in pairs.values()])),
        float(np.mean([each.boundary_distance for each in pairs.values()])),
    )
    return NewConsensus(tuple(answer_id for answer_id, _ in peers), mean, ids[int(np.argmax(means))])


def _measured(mesh: TriMesh, labels: np.ndarray, truth: np.ndarray) -> Closeness:
    areas = face_areas(mesh)
    parts = np.setdiff1d(np.union1d(labels, truth), [NO_CLASS])
    return Closeness(
        _share(accuracy_by_area(labels, truth, areas)),
        _share(mean_iou(part_iou(labels, truth, parts, areas))),
        _share(boundary_distance(mesh, labels, truth)),
    )


def _share(value: float) -> float:
    """Sums of areas may pass 1 by a rounding error."""
    return min(max(value, 0.0), 1.0)


def _of_nothing(is_same: bool) -> Closeness:
    return Closeness(1.0, 1.0, 0.0) if is_same else Closeness(0.0, 0.0, 1.0)
