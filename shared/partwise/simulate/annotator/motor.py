"""How long a person takes: `MotorModel` has the constants, `Hand` where pointer, view and tool are.

The parts are those of the keystroke-level model (Card, Moran, Newell 1980): mental preparation, keys, pointing and
buttons. Pointing follows Fitts' law in Shannon's form (MacKenzie 1992), a drag the steering law (Accot & Zhai 1997), so
a long path with a thin brush is slow. The shape fills the screen: distances are in diagonals of its bounding box. A
target that faces away costs a turn of the view. What hides behind other parts counts as in sight. A person is never
idle.
"""

import math
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from jaxtyping import Bool, Float

from partwise.errors import ParameterError


class Tool(StrEnum):
    """What an annotator may use."""

    PAINT = "paint"
    PATCHES = "patches"
    SEGMENT_WIDE = "segment_wide"
    BOUNDARY_REFINEMENT = "boundary_refinement"


@dataclass(frozen=True, slots=True)
class MotorModel:
    """Seconds, ≥ 0, unless said otherwise.

    orient_s : the first look at a shape. decide_s : what next. prepare_s : another part or tool. key_s : a key.
    button_s : press and release. point_s, point_bit_s : Fitts' law, constant and per bit. steer_s : steering law, per
    length of the path over its width. turn_s : a turn of the view. slider_s : moving the slider of the patches.
    wait_s : until a refinement is shown. judge_s : looking at what it did.
    spread : of the logarithm of a gesture's time. aim : standard deviation of where a click lands, as a share of the
        target's width.

    Raises
    ------
    ParameterError : a negative value, or one that is not finite.
    """

    orient_s: float = 3.0
    decide_s: float = 0.6
    prepare_s: float = 1.35
    key_s: float = 0.28
    button_s: float = 0.2
    point_s: float = 0.1
    point_bit_s: float = 0.23
    steer_s: float = 0.08
    turn_s: float = 1.2
    slider_s: float = 2.0
    wait_s: float = 0.2
    judge_s: float = 1.0
    spread: float = 0.2
    aim: float = 0.05

    def __post_init__(self) -> None:
        for name in self.__slots__:
            if not 0 <= getattr(self, name) < math.inf:
                raise ParameterError(f"{name} must be finite and ≥ 0 but is {getattr(self, name)}; leave it out")


@dataclass(frozen=True, slots=True, eq=False)
class Gesture:
    """What the hand is to do. Lengths in diagonals.

    tool, part : what must be picked first. place, normal : of the target, (3,). width : of what must be hit or kept to.
    path : length of a drag, 0 for a click. end : where it ends. extra_s : slider moves, brush changes.
    """

    tool: Tool
    part: int
    place: Float[np.ndarray, " 3"]
    normal: Float[np.ndarray, " 3"]
    width: float
    end: Float[np.ndarray, " 3"]
    path: float = 0.0
    extra_s: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Hand:
    """Where a person's hand is: pointer and view (3,), the tool and the part in use, None before the first."""

    pointer: Float[np.ndarray, " 3"]
    view: Float[np.ndarray, " 3"]
    tool: Tool | None = None
    part: int | None = None

    def sees(self, normals: Float[np.ndarray, "n 3"]) -> Bool[np.ndarray, " n"]:
        """Whether surface of these normals is turned towards the viewer well enough to work on, (n,) bool."""
        return np.asarray(normals @ self.view > SIDEWAYS)

    def turned_to(self, normal: Float[np.ndarray, " 3"]) -> "Hand":
        """The same hand with `normal` in sight: the view is turned only where it must be."""
        return self if self.sees(normal[None])[0] else replace(self, view=normal)

    def seconds(self, gesture: Gesture, model: MotorModel) -> float:
        """Time of a gesture, without its spread."""
        distance = float(np.linalg.norm(gesture.place - self.pointer))
        bits = math.log2(distance / gesture.width + 1)
        return (
            model.decide_s
            + (model.prepare_s + model.key_s) * ((gesture.tool != self.tool) + (gesture.part != self.part))
            + model.turn_s * (not self.sees(gesture.normal[None])[0])
            + model.point_s + model.point_bit_s * bits
            + model.button_s
            + model.steer_s * gesture.path / gesture.width
            + gesture.extra_s
        )  # fmt: skip

    def after(self, gesture: Gesture) -> "Hand":
        """Where the hand is then."""
        return replace(self.turned_to(gesture.normal), pointer=gesture.end, tool=gesture.tool, part=gesture.part)


SIDEWAYS = 0.25
"""Cosine between the view and a normal below which a person turns the shape first."""
LEAST_WIDTH = 0.01
"""Nothing is aimed at more finely than this, in diagonals: people zoom in."""


def command_s(model: MotorModel) -> float:
    """Time of pressing a command and looking at what it did: a refinement, "start from"."""
    return model.prepare_s + model.key_s + model.wait_s + model.judge_s


def undo_s(model: MotorModel) -> float:
    """Time of taking a step back, once it was judged."""
    return model.decide_s + model.key_s
