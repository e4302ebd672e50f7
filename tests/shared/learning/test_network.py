"""The network is the paper's, and its initial weights depend on nothing but the generator."""

import pytest
import torch
from torch import nn
from torch.nn import functional

from partwise.errors import ParameterError
from partwise.learning.network import NetworkSpec, PartNetwork


def _network(spec: NetworkSpec, seed: int = 0) -> PartNetwork:
    return PartNetwork(spec, torch.Generator().manual_seed(seed))


def _grids(n: int) -> list[torch.Tensor]:
    generator = torch.Generator().manual_seed(1)
    return [torch.rand(n, 256, generator=generator) for _ in range(2)]


def _as_printed(network: PartNetwork, grids: list[torch.Tensor]) -> torch.Tensor:
    """Convolution, activation, then torch's own pooling, as in the paper; channels last before flattening."""
    described = []
    for branch, grid in zip(network.branches.values(), grids, strict=True):
        maps = grid.view(-1, 1, 16, 16)
        for convolution in (branch.first, branch.second):
            maps = functional.max_pool2d(functional.leaky_relu(convolution(maps), 0.2), 2)
        described.append(maps.permute(0, 2, 3, 1).flatten(1))
    hidden = functional.leaky_relu(network.hidden(torch.cat(described, dim=1)), 0.2)
    return network.output(hidden)


def test_it_is_the_function_that_the_paper_prints() -> None:
    network = _network(NetworkSpec(5))
    torch.testing.assert_close(network(_grids(6)), _as_printed(network, _grids(6)), rtol=1e-5, atol=1e-5)


def test_it_has_the_documented_number_of_parameters() -> None:
    branch = (9 * 16 + 16) + (9 * 16 * 32 + 32)
    joined = (2 * 512 * 128 + 128) + (128 * 4 + 4)
    assert sum(p.numel() for p in _network(NetworkSpec(4)).parameters()) == 2 * branch + joined


def test_every_parameter_receives_a_gradient() -> None:
    network = _network(NetworkSpec(4))
    network(_grids(32)).square().sum().backward()
    assert all(p.grad is not None and p.grad.abs().max() > 0 for p in network.parameters())


def test_the_same_generator_gives_the_same_weights() -> None:
    one, other = (_network(NetworkSpec(4), seed=5).state_dict() for _ in range(2))
    assert all(torch.equal(one[name], other[name]) for name in one)


def test_another_seed_gives_other_weights() -> None:
    one, other = (_network(NetworkSpec(4), seed=seed).output.weight for seed in (5, 6))
    assert not torch.equal(one, other)


def test_torchs_global_generator_is_not_touched() -> None:
    before = torch.get_rng_state()
    _network(NetworkSpec(4))
    assert torch.equal(before, torch.get_rng_state())


def test_branches_are_those_of_the_spec() -> None:
    network = _network(NetworkSpec(4, branches=("spin_image",)))
    assert list(network.branches) == ["spin_image"]
    assert isinstance(network.hidden, nn.Linear)
    assert network.hidden.in_features == 512


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"n_parts": 1}, "n_parts"),
        ({"n_parts": 2, "widths": (16,)}, "widths"),
        ({"n_parts": 2, "widths": (16, 0)}, "widths"),
        ({"n_parts": 2, "hidden": 0}, "hidden"),
        ({"n_parts": 2, "branches": ()}, "branches"),
        ({"n_parts": 2, "branches": ("a", "a")}, "branches"),
    ],
)
def test_impossible_shapes_are_refused(options: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        NetworkSpec(**options)
