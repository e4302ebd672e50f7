import numpy as np
import pytest

from partwise.render.palette import N_PART_COLOURS, UNLABELLED_COLOUR, colours_of_labels, part_colour

# Machado, Oliveira, Fernandes 2009, severity 1.0, on linear RGB.
VISION = {
    "full": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
RGB_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
D65 = np.array([0.9505, 1.0, 1.089])


def _cielab(colours: np.ndarray, vision: np.ndarray) -> np.ndarray:
    values = colours / 255.0
    linear = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    xyz = np.clip(linear @ vision.T, 0, 1) @ RGB_TO_XYZ.T / D65
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], axis=1)


@pytest.mark.parametrize("vision", VISION)
def test_all_colours_and_grey_stay_apart_for_every_eye(vision: str) -> None:
    lab = _cielab(colours_of_labels(np.arange(-1, N_PART_COLOURS)).astype(np.float64), VISION[vision])
    distances = np.linalg.norm(lab[:, None] - lab[None], axis=2)
    assert distances[~np.eye(len(lab), dtype=bool)].min() > 15.0  # 2.3 is just noticeable side by side


def test_labels_and_indices_agree() -> None:
    labels = np.array([-3, -1, 0, 5, N_PART_COLOURS, 3 * N_PART_COLOURS + 2])
    np.testing.assert_array_equal(colours_of_labels(labels), [part_colour(int(label)) for label in labels])


def test_unlabelled_is_grey() -> None:
    assert part_colour(-1) == UNLABELLED_COLOUR
    assert len(set(UNLABELLED_COLOUR)) == 1


def test_colours_repeat_after_the_last() -> None:
    assert part_colour(N_PART_COLOURS) == part_colour(0)
