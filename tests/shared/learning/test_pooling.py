"""Pooling agrees with torch's, forward and backward."""

import torch
from torch.nn import functional

from partwise.learning.pooling import max_pool_2x2


def _maps(seed: int) -> torch.Tensor:
    return torch.randn(3, 8, 6, 5, generator=torch.Generator().manual_seed(seed), requires_grad=True)


def _reference(maps: torch.Tensor) -> torch.Tensor:
    return functional.max_pool2d(maps.permute(0, 3, 1, 2), 2).permute(0, 2, 3, 1)


def test_it_is_torchs_max_pool() -> None:
    assert torch.equal(max_pool_2x2(_maps(0)), _reference(_maps(0)))


def test_its_gradient_is_torchs() -> None:
    maps = _maps(1)
    weights = torch.randn(3, 4, 3, 5, generator=torch.Generator().manual_seed(2))
    ours, theirs = (torch.autograd.grad((f(maps) * weights).sum(), maps)[0] for f in (max_pool_2x2, _reference))
    assert torch.equal(ours, theirs)


def test_of_equal_values_one_receives_the_whole_gradient() -> None:
    maps = torch.zeros(1, 2, 2, 1, requires_grad=True)
    (gradient,) = torch.autograd.grad(max_pool_2x2(maps).sum(), maps)
    assert gradient.flatten().tolist() == [1, 0, 0, 0]
