"""Stage `picture`: images of the working mesh that fit their block; what shapes them is in the key."""

import numpy as np

from partwise.render.face_picture import face_id_image
from partwise.store.block_kinds import PICTURE
from partwise.store.meshes import mesh_arrays
from partwise.store.ragged import ragged_quantities
from partwise.testing.spheres import ball
from partwise_workers.stage import StageResult, stage_key
from partwise_workers.stages.picture import PictureStage


class Inputs:
    """A working mesh, and nothing else."""

    failed_steps: dict[str, str] = {}  # noqa: RUF012

    def __init__(self) -> None:
        self._arrays = mesh_arrays(ball(1))

    def array(self, stage: str, quantity: str) -> np.ndarray:
        assert stage == "remesh"
        return self._arrays[quantity]


def _result() -> StageResult:
    with PictureStage("y").open(None) as run:
        return run(Inputs())


def test_the_result_fits_its_block() -> None:
    names = {each.quantity.name for each in ragged_quantities(PICTURE, [_result().arrays])}
    assert names == {"face_ids", "shading"}


def test_the_images_are_of_the_working_mesh() -> None:
    result = _result()
    np.testing.assert_array_equal(result.arrays["face_ids"], face_id_image(ball(1)).face_ids)
    assert result.summary["mesh_hash"] == ball(1).content_hash()


def test_which_axis_is_up_is_part_of_the_key() -> None:
    assert stage_key(PictureStage("y"), "0" * 64) != stage_key(PictureStage("z"), "0" * 64)
