"""2×2 max-pooling of channels-last maps, in elementwise operations.

The same function as `torch.nn.functional.max_pool2d(x, 2)`, but quicker on CPUs, because nothing is gathered or
scattered by index, and with a gradient that is deterministic on every device.
"""

from typing import Any

import torch
from jaxtyping import Float
from torch import Tensor

_keep_where_positive = torch.ops.aten.threshold_backward


def max_pool_2x2(maps: Float[Tensor, "b h w c"]) -> Float[Tensor, "b h/2 w/2 c"]:
    """Maximum of each 2×2 block of positions.

    Parameters
    ----------
    maps : (b, h, w, c), contiguous, h and w even.

    Returns
    -------
    (b, h/2, w/2, c). Of equal values the upper, then the left one receives the gradient.
    """
    pooled: Tensor = _MaxPool2x2.apply(maps)  # type: ignore[no-untyped-call] # torch's Function.apply is untyped
    return pooled


class _MaxPool2x2(torch.autograd.Function):
    """Pools rows, then columns. The differences' signs tell the way back."""

    @staticmethod
    def forward(ctx: Any, maps: Tensor) -> Tensor:
        b, h, w, c = maps.shape
        top, bottom = maps.view(b, h // 2, 2, w, c).unbind(2)
        rows = torch.maximum(top, bottom)
        left, right = rows.view(b, h // 2, w // 2, 2, c).unbind(3)
        ctx.save_for_backward(bottom - top, right - left)
        return torch.maximum(left, right)

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> Tensor:
        (gradient,) = gradients
        downward, rightward = ctx.saved_tensors
        b, half_h, half_w, c = gradient.shape
        of_rows = gradient.new_empty(b, half_h, half_w, 2, c)
        _split(gradient, rightward, *of_rows.unbind(3))
        of_maps = gradient.new_empty(b, half_h, 2, 2 * half_w, c)
        _split(of_rows.view(b, half_h, 2 * half_w, c), downward, *of_maps.unbind(2))
        return of_maps.view(b, 2 * half_h, 2 * half_w, c)


def _split(gradient: Tensor, difference: Tensor, first: Tensor, second: Tensor) -> None:
    """Writes the gradient to `second` where the difference is positive and to `first` elsewhere, 0 to the other."""
    to_second = _keep_where_positive(gradient, difference, 0)
    second.copy_(to_second)
    torch.sub(gradient, to_second, out=first)
