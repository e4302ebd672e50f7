"""The first layer agrees with torch's convolution and pooling, forward and backward."""

import torch
from torch import Tensor
from torch.nn import functional

from partwise.learning.stem import convolve_and_pool


def _random(*shape: int, seed: int) -> Tensor:
    return torch.randn(*shape, generator=torch.Generator().manual_seed(seed), dtype=torch.float64)


def _reference(grids: Tensor, kernels: Tensor) -> Tensor:
    return functional.max_pool2d(functional.conv2d(grids[:, None], kernels, padding=1), 2).permute(0, 2, 3, 1)


def test_it_is_torchs_convolution_and_max_pool() -> None:
    grids, kernels = _random(3, 8, 6, seed=0), _random(5, 1, 3, 3, seed=1)
    torch.testing.assert_close(convolve_and_pool(grids, kernels), _reference(grids, kernels))


def test_its_gradient_is_torchs() -> None:
    grids, kernels, weights = _random(3, 8, 6, seed=0), _random(5, 1, 3, 3, seed=1), _random(3, 4, 3, 5, seed=2)
    kernels.requires_grad_()
    ours, theirs = (
        torch.autograd.grad((f(grids, kernels) * weights).sum(), kernels)[0] for f in (convolve_and_pool, _reference)
    )
    torch.testing.assert_close(ours, theirs)


def test_of_equal_values_one_receives_the_whole_gradient() -> None:
    kernels = torch.zeros(1, 1, 3, 3, requires_grad=True)
    grids = torch.tensor([[[1.0, 2.0], [3.0, 4.0]]])
    (gradient,) = torch.autograd.grad(convolve_and_pool(grids, kernels).sum(), kernels)
    # The window's four candidates are all 0: the upper left one, centred on the 1, is taken.
    assert gradient[0, 0].tolist() == [[0, 0, 0], [0, 1, 2], [0, 3, 4]]
