"""What could be done next: for each tool, the strokes that a person would think of, with gain and time.

A move's gain is the share of the area that it is expected to make right, less what it makes wrong.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int, UInt16

from partwise.geometry.adjacency import label_regions
from partwise.labels.operations import Assign, Paint, SegmentWide
from partwise.segmentation.paint import Brush
from partwise.simulate.annotator.kernels.scribble import scribble
from partwise.simulate.annotator.motor import LEAST_WIDTH, Gesture, Hand, MotorModel, Tool
from partwise.simulate.annotator.sight import Sight
from partwise.unlabelled import NO_PART_ID

N_REGIONS = 3
"""So many of the largest wrong regions a person weighs up for painting."""
BRUSHES = (0.9, 0.55, 0.3)
"""Radii weighed up, as shares of the room that the widest spot of a region leaves."""
MAX_RADIUS = 0.3
MAX_CLICKS = 40
"""Faces that one drag passes at most."""
MAX_DRAG_PATCHES = 5
LEAST_FACING = 0.25
"""Share of a patch that must face the viewer for a drag to go on to it."""
LEAST_GAIN = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """An operation, the gesture that makes it, and what it is expected to gain.

    level : index of how many patches are shown afterwards.
    """

    operation: Paint | Assign | SegmentWide
    gesture: Gesture
    gain: float
    level: int


@dataclass(frozen=True, slots=True, eq=False)
class Outlook:
    """What a person has before them.

    labels : (m,) now. hand : where it is. level : index of how many patches are shown. patches : of each level, (m,)
    int64; none where the tool is not to be used.
    """

    sight: Sight
    labels: UInt16[np.ndarray, " m"]
    hand: Hand
    model: MotorModel
    patches: Sequence[Int[np.ndarray, " m"]]
    level: int


def segment_moves(outlook: Outlook) -> Iterator[Move]:
    """One click on the connected region of equal label that gains most."""
    sight = outlook.sight
    region = label_regions(outlook.labels, sight.pairs)
    part, gain = sight.gain_table(outlook.labels, region)
    best = int(np.argmax(gain))
    if gain[best] <= LEAST_GAIN or part[best] == NO_PART_ID:
        return
    faces = np.flatnonzero(region == best)
    seed = _easiest(outlook, faces)
    gesture = _click(outlook, Tool.SEGMENT_WIDE, int(part[best]), faces, seed)
    yield Move(SegmentWide(seed, int(part[best])), gesture, float(gain[best]), outlook.level)


def patch_moves(outlook: Outlook) -> Iterator[Move]:
    """The patch that gains most, and its neighbours of the same part in one drag; now, or with more patches shown."""
    for level in range(outlook.level, len(outlook.patches)):
        patches = outlook.patches[level]
        part, gain = outlook.sight.gain_table(outlook.labels, patches)
        gain = np.where(part == NO_PART_ID, 0.0, gain)
        if gain.max() <= LEAST_GAIN:
            continue
        chosen = _drag_over(outlook, patches, part, gain)
        faces = np.flatnonzero(patches == chosen[0])
        gesture = _click(outlook, Tool.PATCHES, int(part[chosen[0]]), faces, _easiest(outlook, faces))
        if len(chosen) > 1:
            centres = _centres(outlook.sight, patches)[chosen]
            path = float(np.linalg.norm(np.diff(centres, axis=0), axis=1).sum())
            gesture = replace(gesture, path=path, end=centres[-1])
        gesture = replace(gesture, extra_s=outlook.model.slider_s * (level != outlook.level))
        taken = np.flatnonzero(np.isin(patches, chosen))
        operation = Assign.to_faces(taken, int(part[chosen[0]]))
        yield Move(operation, gesture, float(gain[chosen].sum()), level)


def paint_moves(outlook: Outlook) -> Iterator[Move]:
    """Drags through the largest wrong regions, each with several brushes. The brush stays clear of other parts."""
    sight = outlook.sight
    wanted = np.where(sight.is_wrong(outlook.labels), sight.belongs, NO_PART_ID)
    region = label_regions(wanted, sight.pairs)
    size = np.bincount(region, weights=np.where(wanted == NO_PART_ID, 0.0, sight.areas))
    for largest in np.argsort(-size, kind="stable")[:N_REGIONS]:
        if size[largest] <= 0:
            return
        faces = np.flatnonzero(region == largest)
        widest = min(float(sight.room[faces].max()), MAX_RADIUS)
        for share in BRUSHES:
            yield _drag(outlook, faces, max(share * widest, 1e-4))


def _drag(outlook: Outlook, faces: Int[np.ndarray, " k"], radius: float) -> Move:
    """Through the faces of a region with a brush of this radius, from the spot with most room, without turning."""
    sight = outlook.sight
    points, room = sight.points[faces], sight.room[faces]
    start = int(np.argmax(np.where(outlook.hand.sees(sight.normals[faces]), room, room / 2)))
    in_sight = outlook.hand.turned_to(sight.normals[faces[start]]).sees(sight.normals[faces])
    eligible = in_sight & (room >= min(radius, float(room[start])))
    seeds, is_covered = scribble(points, eligible, start, radius, 2.5 * radius, MAX_CLICKS)
    landed = tuple(faces[seeds].tolist())
    path = float(np.linalg.norm(np.diff(points[seeds], axis=0), axis=1).sum())
    part = int(sight.belongs[faces[0]])
    is_same_brush = outlook.hand.tool == Tool.PAINT and outlook.hand.part == part
    gesture = Gesture(
        tool=Tool.PAINT,
        part=part,
        place=points[seeds[0]],
        normal=sight.normals[landed[0]],
        width=max(2 * radius, LEAST_WIDTH),
        end=points[seeds[-1]],
        path=path,
        extra_s=0.0 if is_same_brush else outlook.model.key_s,
    )
    # What lies behind the shape's rim is reached by chance only: what is in sight counts.
    taken = faces[is_covered & (in_sight | (room > radius))]
    return Move(Paint(landed, Brush(radius), part), gesture, float(sight.areas[taken].sum()), outlook.level)


def _drag_over(
    outlook: Outlook, patches: Int[np.ndarray, " m"], part: Int[np.ndarray, " g"], gain: Float[np.ndarray, " g"]
) -> Int[np.ndarray, " c"]:
    """The patch that gains most, then neighbour after neighbour of the same part that is in sight with it."""
    sight = outlook.sight
    best = int(np.argmax(gain))
    faces = np.flatnonzero(patches == best)
    hand = outlook.hand.turned_to(sight.normals[_easiest(outlook, faces)])
    facing = np.where(hand.sees(sight.normals), sight.areas, 0.0)
    share = np.bincount(patches, weights=facing) / np.maximum(np.bincount(patches, weights=sight.areas), 1e-12)
    fits = (part == part[best]) & (gain > LEAST_GAIN) & (gain > gain[best] / 10) & (share > LEAST_FACING)
    first, second = patches[sight.pairs].T
    chosen = [best]
    while len(chosen) < MAX_DRAG_PATCHES:
        near = np.concatenate([second[first == chosen[-1]], first[second == chosen[-1]]])
        near = np.setdiff1d(near[fits[near]], chosen)
        if not len(near):
            break
        chosen.append(int(near[np.argmax(gain[near])]))
    return np.array(chosen)


def _click(outlook: Outlook, tool: Tool, part: int, faces: Int[np.ndarray, " k"], seed: int) -> Gesture:
    width = np.sqrt(outlook.sight.areas[faces].sum())  # of a shape about one diagonal large
    place = outlook.sight.points[seed]
    return Gesture(tool, part, place, outlook.sight.normals[seed], max(float(width), LEAST_WIDTH), place)


def _easiest(outlook: Outlook, faces: Int[np.ndarray, " k"]) -> int:
    """The face to click for a region: in sight if one is, and near its middle."""
    sight = outlook.sight
    middle = sight.points[faces].mean(axis=0)
    distance = np.linalg.norm(sight.points[faces] - middle, axis=1)
    is_hidden = ~outlook.hand.sees(sight.normals[faces])
    return int(faces[np.argmin(distance + 10.0 * is_hidden)])


def _centres(sight: Sight, patches: Int[np.ndarray, " m"]) -> Float[np.ndarray, "g 3"]:
    n = np.maximum(np.bincount(patches), 1)
    return np.stack([np.bincount(patches, weights=axis) / n for axis in sight.points.T], axis=1)
