"""Core-seconds and memory of describing meshes."""

import resource
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from partwise.features.describe import Describer
from partwise.features.parameters import DescribeParameters
from partwise.io.read import read_mesh
from partwise.simulate.collection import simulate_shape

WARM_UP_FACES = 6000


@dataclass(frozen=True, slots=True)
class DescribeTiming:
    """core_s : descriptor → processor seconds of all threads, and "total", reading and normalising included.

    peak_mb : highest resident memory of the process so far, in megabytes; the largest file sets it.
    """

    file: str
    n_faces: int
    core_s: dict[str, float]
    wall_s: float
    peak_mb: float


def time_descriptions(files: Sequence[Path]) -> Iterator[DescribeTiming]:
    """Describes each file after one warm-up shape, which compiles the kernels and opens the renderer.

    Every file is read once before anything is timed, so that a wrong one is told of at once.

    Raises
    ------
    FileFormatError : a file is no mesh.
    """
    for file in files:
        read_mesh(file)
    with Describer(DescribeParameters()) as describer:
        describer.describe(simulate_shape("mugs", 0, "warm-up", n_faces=WARM_UP_FACES).mesh)
        for file in files:
            wall, core = time.perf_counter(), time.process_time()
            mesh = read_mesh(file)
            description = describer.describe(mesh)
            total = time.process_time() - core
            core_s = {name: round(seconds, 3) for name, seconds in (*description.core_s.items(), ("total", total))}
            peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            yield DescribeTiming(
                str(file), mesh.n_faces, core_s, round(time.perf_counter() - wall, 3), round(peak_mb, 1)
            )
