"""Random numbers of a shape by its name, so that what is drawn for it depends on no other shape of the folder."""

import numpy as np


def shape_rng(seed: int, shape: str, purpose: str) -> np.random.Generator:
    """Always the same for a seed, a shape's name and a purpose."""
    key = tuple(f"{shape} {purpose}".encode())
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
