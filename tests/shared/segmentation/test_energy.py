"""The Potts energy: analytic values and what a problem may not be."""

import numpy as np
import pytest

from partwise.errors import LabelError, ParameterError
from partwise.segmentation.energy import LabelProblem, energy

UNARY = np.array([[0.0, 1.0], [2.0, 0.5], [4.0, 0.0]])
EDGES = np.array([[0, 1], [1, 2], [1, 2]])
WEIGHTS = np.array([10.0, 20.0, 40.0])
PROBLEM = LabelProblem(UNARY, EDGES, WEIGHTS)


@pytest.mark.parametrize(
    ("labels", "expected"),
    [([0, 0, 0], 6.0), ([1, 1, 1], 1.5), ([0, 1, 1], 0.5 + 10), ([0, 0, 1], 2 + 60), ([0, 1, 0], 4.5 + 70)],
)
def test_values(labels, expected):
    assert energy(PROBLEM, np.array(labels)) == expected


def test_without_edges_only_the_data_count():
    problem = LabelProblem(UNARY, np.zeros((0, 2), dtype=np.int64), np.zeros(0))
    assert energy(problem, np.array([0, 1, 0])) == 4.5


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"unary": np.zeros(3)}, "non-empty"),
        ({"unary": np.zeros((3, 0))}, "non-empty"),
        ({"unary": np.zeros((0, 2))}, "non-empty"),
        ({"edges": EDGES.T}, "weight each"),
        ({"weights": WEIGHTS[:2]}, "weight each"),
        ({"unary": UNARY + np.inf}, "finite"),
        ({"weights": WEIGHTS * np.nan}, "finite"),
        ({"weights": -WEIGHTS}, "≥ 0"),
        ({"edges": EDGES + 1}, "below 3 but reach 3"),
        ({"edges": EDGES - 1}, "below 3"),
        ({"edges": np.array([[0, 1], [1, 2], [2, 2]])}, "loops"),
    ],
)
def test_refuses(changes, message):
    with pytest.raises(ParameterError, match=message):
        LabelProblem(**{"unary": UNARY, "edges": EDGES, "weights": WEIGHTS, **changes})


@pytest.mark.parametrize("labels", [[0, 0], [0, 0, 2], [0, 0, -1]])
def test_refuses_labels(labels):
    with pytest.raises(LabelError, match="labels must be"):
        energy(PROBLEM, np.array(labels))
