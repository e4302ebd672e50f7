"""Settings of the queue: defaults, and what is refused."""

from typing import Any

import pytest

from partwise.errors import ParameterError
from partwise.store.queue_settings import QueueSettings, queue_settings_of


def test_other_keys_are_left_alone() -> None:
    assert queue_settings_of({"up": "z", "review": True}) == QueueSettings(review=True)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("labels_per_shape", 0),
        ("labels_per_shape", 10),
        ("labels_per_shape", 1.5),
        ("labels_per_shape", True),
        ("train_after", -1),
        ("agreement", 1.1),
        ("agreement", "high"),
        ("honeypot_share", -0.1),
        ("honeypot_share", True),
        ("review", 1),
    ],
)
def test_values_out_of_range_are_refused(name: str, value: Any) -> None:
    with pytest.raises(ParameterError, match=name):
        queue_settings_of({name: value})
