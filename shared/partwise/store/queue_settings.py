"""How a collection's work is handed out: rows of its settings, each with a default."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from partwise.errors import ParameterError

MAX_LABELS_PER_SHAPE = 9


@dataclass(frozen=True, slots=True)
class QueueSettings:
    """Settings of a collection's queue.

    labels_per_shape : people who label each shape, independently of each other; 1 … 9.
    agreement : mean share of the area, in [0, 1], on which their labels must agree pairwise to be taken.
    honeypot_share : share in [0, 1] of claims that get a shape whose true labels are known, to measure people by.
    review : a reviewer looks at all confirmed labels before they are trained on.
    train_after : confirmed shapes after which a training is asked for; 0 for never by itself.

    Raises
    ------
    ParameterError : a value out of its range, or of another type.
    """

    labels_per_shape: int = 1
    agreement: float = 0.9
    honeypot_share: float = 0.0
    review: bool = False
    train_after: int = 5

    def __post_init__(self) -> None:
        for name, lowest, highest in (
            ("labels_per_shape", 1, MAX_LABELS_PER_SHAPE),
            ("train_after", 0, 1_000_000),
        ):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool) or not lowest <= value <= highest:
                raise ParameterError(f"{name} must be a whole number {lowest} to {highest:,} but is {value!r}")
        for name in ("agreement", "honeypot_share"):
            value = getattr(self, name)
            if not isinstance(value, int | float) or isinstance(value, bool) or not 0 <= value <= 1:
                raise ParameterError(f"{name} must be a share in [0, 1] but is {value!r}; 0.9 is nine tenths")
        if not isinstance(self.review, bool):
            raise ParameterError(f"review must be true or false but is {self.review!r}")


def queue_settings_of(settings: Mapping[str, Any]) -> QueueSettings:
    """The queue's part of a collection's settings; other keys are left alone.

    Raises
    ------
    ParameterError : a value out of its range.
    """
    known = {each.name for each in fields(QueueSettings)}
    return QueueSettings(**{key: value for key, value in settings.items() if key in known})
