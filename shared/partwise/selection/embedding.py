"""PCA of light-field descriptors: where each shape lies among the others of its collection.

`fit_embedding` learns an `Embedding` from a stream of descriptor batches in bounded memory; `Embedding.project` places
any shape, also ones that came later, without refitting.
"""

import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import IO, Self

import numpy as np
from jaxtyping import Float32, UInt8

from partwise.errors import NotEnoughDataError, ParameterError

MAX_DIMENSIONS = 128
MAX_SAMPLE = 10_000
N_EXTRA_DIRECTIONS = 32  # oversampling of the randomised range finder
N_POWER_ITERATIONS = 3
CHUNK_ROWS = 64  # descriptors held as float32 at a time: 53 MB of LFDs
GRAM_BLOCK_ROWS = 16_384
GRAM_FLOOR = 1e-11  # of the largest squared length: float32 holds nothing below
RELATIVE_VARIANCE_FLOOR = 1e-9  # of the total; directions below are rounding, not shape


@dataclass(frozen=True, slots=True, eq=False)
class Embedding:
    """A fitted PCA: `project(x) = (x − mean) @ components.T`.

    mean : (d,) float32, in stored descriptor units (0 to 255). components : (k, d) float32, orthonormal rows, most
    variance first; in each the entry of largest magnitude is positive. explained_variance_ratio : (k,) float32, each
    component's share of the sample's variance.

    Raises
    ------
    ParameterError : shapes that do not fit each other, or values that are not finite.
    """

    mean: Float32[np.ndarray, " d"]
    components: Float32[np.ndarray, "k d"]
    explained_variance_ratio: Float32[np.ndarray, " k"]

    def __post_init__(self) -> None:
        for name in ("mean", "components", "explained_variance_ratio"):
            values = np.array(getattr(self, name), dtype=np.float32, order="C")
            if not np.isfinite(values).all():
                raise ParameterError(f"an embedding must be finite but its {name} is not; fit it again")
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        expected = (*self.explained_variance_ratio.shape, *self.mean.shape)
        if self.components.ndim != 2 or self.components.shape != expected:
            raise ParameterError(
                f"components must be (dimensions, length) = {expected} but are {self.components.shape}; "
                "are the arrays from one embedding?"
            )

    @property
    def n_dimensions(self) -> int:
        return len(self.components)

    def project(self, descriptors: UInt8[np.ndarray, "b d"]) -> Float32[np.ndarray, "b k"]:
        """Coordinates of descriptors, (b, k) float32, in stored descriptor units.

        Raises
        ------
        ParameterError : descriptors of another length than those that were fitted.
        """
        if descriptors.ndim != 2 or descriptors.shape[1] != len(self.mean):
            raise ParameterError(
                f"descriptors must be (shapes, {len(self.mean)}) but are {descriptors.shape}; "
                "describe and embed with one version"
            )
        points = np.empty((len(descriptors), self.n_dimensions), dtype=np.float32)
        for start in range(0, len(descriptors), CHUNK_ROWS):
            rows = slice(start, start + CHUNK_ROWS)
            points[rows] = (descriptors[rows].astype(np.float32) - self.mean) @ self.components.T
        return points

    def to_arrays(self) -> dict[str, np.ndarray]:
        """The three arrays by name, to be stored."""
        return {
            "mean": self.mean,
            "components": self.components,
            "explained_variance_ratio": self.explained_variance_ratio,
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, np.ndarray]) -> Self:
        """Inverse of `to_arrays`.

        Raises
        ------
        ParameterError : an array is missing, or they do not fit each other.
        """
        missing = {"mean", "components", "explained_variance_ratio"} - set(arrays)
        if missing:
            raise ParameterError(
                f"an embedding needs the array {min(missing)!r} but has {sorted(arrays)}; fit it again"
            )
        return cls(arrays["mean"], arrays["components"], arrays["explained_variance_ratio"])


def fit_embedding(
    batches: Iterable[UInt8[np.ndarray, "b d"]],
    rng: np.random.Generator,
    max_dimensions: int = MAX_DIMENSIONS,
    max_sample: int = MAX_SAMPLE,
) -> Embedding:
    """PCA to min(max_dimensions, n − 1) dimensions, fewer where the sample spans fewer.

    Parameters
    ----------
    batches : descriptors, (b, d) uint8 each, in any number of batches; read once. Where they are many more than
        max_sample it is cheaper to draw the shapes first (`sample_rows`) than to stream them all through here.
    rng : draws the sample and the random directions; the same seed and stream give the same embedding.
    max_dimensions : ≥ 1. max_sample : ≥ 2; a uniform sample of this many is fitted where there are more.

    Returns
    -------
    Embedding. Memory: (max_dimensions + 32)·d float32 a few times over, about 0.6 GB for LFDs, whatever n is; the
    sample lies in a temporary file of at most max_sample·d bytes.

    Raises
    ------
    ParameterError : limits out of range, or batches that are not (b, d) uint8 of one d.
    NotEnoughDataError : fewer than two descriptors, or all are equal.

    Source: Halko, Martinsson, Tropp 2011 (randomised subspace iteration); Vitter 1985 (reservoir sampling). Differs:
    exact for up to max_dimensions + 32 descriptors, whose span is found whole.
    """
    if max_dimensions < 1 or max_sample < 2:
        raise ParameterError(
            f"an embedding needs max_dimensions ≥ 1 and max_sample ≥ 2 but they are {max_dimensions} and {max_sample}; "
            "raise them"
        )
    with tempfile.TemporaryFile(prefix="partwise-embedding-") as spool:
        sample = _reservoir_sample(batches, max_sample, rng, spool)
        if len(sample) < 2:
            raise NotEnoughDataError(f"an embedding needs 2 shapes or more but got {len(sample)}; describe more shapes")
        return _fit(sample, max_dimensions, rng)


def sample_rows(n_shapes: int, rng: np.random.Generator, max_sample: int = MAX_SAMPLE) -> np.ndarray:
    """Ascending rows of a uniform sample of at most max_sample out of n_shapes, (s,) int64."""
    return np.sort(rng.choice(n_shapes, size=min(n_shapes, max_sample), replace=False))


def _reservoir_sample(
    batches: Iterable[np.ndarray], max_sample: int, rng: np.random.Generator, spool: IO[bytes]
) -> np.ndarray:
    """Uniform sample of the stream's rows as an (s, d) uint8 map of the spool file."""
    length, n_seen = 0, 0
    for batch in batches:
        if batch.ndim != 2 or batch.dtype != np.uint8 or (n_seen and batch.shape[1] != length):
            raise ParameterError(
                f"descriptors must come as (shapes, {length or 'length'}) uint8 but a batch is "
                f"{batch.shape} {batch.dtype}; describe all shapes with one version"
            )
        length = batch.shape[1]
        for row in batch:
            slot = n_seen if n_seen < max_sample else int(rng.integers(n_seen + 1))
            n_seen += 1
            if slot < max_sample:
                spool.seek(slot * length)
                spool.write(row.tobytes())
    spool.flush()
    n_kept = min(n_seen, max_sample)
    if n_kept * length == 0:
        return np.zeros((0, length), dtype=np.uint8)
    return np.memmap(spool, dtype=np.uint8, mode="r", shape=(n_kept, length))


def _fit(sample: np.ndarray, max_dimensions: int, rng: np.random.Generator) -> Embedding:
    """PCA of the sample's rows, passing over them a chunk at a time."""
    n, length = sample.shape
    mean, total_variance = _mean_and_total_variance(sample)
    n_directions = min(n, length, max_dimensions + N_EXTRA_DIRECTIONS)
    weights = rng.standard_normal((n, n_directions), dtype=np.float32)
    basis = _orthonormal(_transposed_product(sample, mean, weights))
    # A span found whole (n directions for n rows) needs no iterating.
    for _ in range(N_POWER_ITERATIONS if n_directions < n else 0):
        basis = _orthonormal(_transposed_product(sample, mean, _product(sample, mean, basis)))
    scores = _product(sample, mean, basis).astype(np.float64)
    _, singular_values, rotation = np.linalg.svd(scores, full_matrices=False)
    ratio = np.square(singular_values) / total_variance
    n_kept = min(max_dimensions, n - 1, int((ratio > RELATIVE_VARIANCE_FLOOR).sum()))
    components = rotation[:n_kept].astype(np.float32) @ basis.T
    return Embedding(mean, _with_fixed_signs(components), ratio[:n_kept].astype(np.float32))


def _mean_and_total_variance(sample: np.ndarray) -> tuple[np.ndarray, float]:
    """Mean (d,) float32 and the summed squared distance to it. Sums of bytes and their squares are exact in float64."""
    total, total_of_squares = np.zeros(sample.shape[1]), 0.0
    for chunk in _chunks(sample):
        exact = chunk.astype(np.float64)
        total += exact.sum(axis=0)
        total_of_squares += float(np.vdot(exact, exact))
    mean = total / len(sample)
    variance = total_of_squares - len(sample) * float(mean @ mean)
    if not variance > RELATIVE_VARIANCE_FLOOR * total_of_squares:
        raise NotEnoughDataError(
            f"an embedding needs shapes that differ but all {len(sample)} are equal; add other shapes"
        )
    return mean.astype(np.float32), variance


def _chunks(sample: np.ndarray) -> Iterable[np.ndarray]:
    for start in range(0, len(sample), CHUNK_ROWS):
        yield sample[start : start + CHUNK_ROWS].astype(np.float32)


def _product(sample: np.ndarray, mean: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """(X − mean) @ basis, (n, l). The mean is taken off afterwards, which spares a pass over each chunk."""
    return np.concatenate([chunk @ basis for chunk in _chunks(sample)]) - mean @ basis


def _transposed_product(sample: np.ndarray, mean: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(X − mean).T @ weights, (d, l), by centring the weights instead: 1.T @ weights = 0."""
    centred = weights - weights.mean(axis=0, dtype=np.float64).astype(np.float32)
    product = -np.outer(mean, centred.sum(axis=0))  # what rounding leaves of it
    for k, chunk in enumerate(_chunks(sample)):
        product += chunk.T @ centred[k * CHUNK_ROWS : k * CHUNK_ROWS + len(chunk)]
    return product


def _orthonormal(basis: np.ndarray) -> np.ndarray:
    """Orthonormal float32 columns spanning those of basis, without directions lost in rounding.

    By the eigenvectors of the Gram matrix, twice because the first time loses orthogonality: 20 times faster than QR
    for matrices this tall.
    """
    for _ in range(2):
        gram = sum(part.T @ part for part in _row_blocks(basis))
        variances, vectors = np.linalg.eigh(gram)
        is_kept = variances > GRAM_FLOOR * variances[-1]
        basis = basis @ (vectors[:, is_kept] / np.sqrt(variances[is_kept])).astype(np.float32)
    return basis


def _row_blocks(basis: np.ndarray) -> Iterable[np.ndarray]:
    for start in range(0, len(basis), GRAM_BLOCK_ROWS):
        yield basis[start : start + GRAM_BLOCK_ROWS].astype(np.float64)


def _with_fixed_signs(components: np.ndarray) -> np.ndarray:
    """The same components, each with its entry of largest magnitude positive."""
    largest = components[np.arange(len(components)), np.abs(components).argmax(axis=1)]
    return components * np.where(largest < 0, np.float32(-1), np.float32(1))[:, None]
