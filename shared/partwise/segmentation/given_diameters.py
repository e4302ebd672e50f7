"""Shape diameters that a caller has at hand: that they are this mesh's."""

import numpy as np
from jaxtyping import Float

from partwise.errors import ParameterError
from partwise.mesh import TriMesh


def checked_diameters(mesh: TriMesh, diameters: np.ndarray) -> Float[np.ndarray, " m"]:
    """The diameters as (m,) float64.

    Raises
    ------
    ParameterError : not one finite value a face.
    """
    checked = np.asarray(diameters, dtype=np.float64)
    if checked.shape != (mesh.n_faces,) or not np.isfinite(checked).all():
        raise ParameterError(
            f"shape diameters must be ({mesh.n_faces},) finite numbers but are {checked.shape}, or some are not; "
            "are they another mesh's?"
        )
    return checked
