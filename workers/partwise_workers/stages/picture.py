"""Stage `picture`: which face each pixel of a thumbnail shows, and how bright, so that labels need only colour it."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from partwise.render.thumbnail import PICTURE_SIZE
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import PICTURE
from partwise.store.blocks import BlockKind
from partwise.workspace.settings import Axis
from partwise_workers.stage import RunStage, ShapeInputs, StageResult
from partwise_workers.stages import describe, remesh

NAME = "picture"


@dataclass(frozen=True, slots=True)
class PictureStage:
    """Looks at the working mesh once. up : the axis that points up.

    It comes after `describe`, whose results must not depend on pictures; so new descriptors bring new pictures, which
    cost little beside them.
    """

    up: Axis

    @property
    def name(self) -> str:
        return NAME

    @property
    def reads(self) -> str:
        return describe.NAME

    @property
    def block_kind(self) -> BlockKind:
        return PICTURE

    @property
    def n_steps(self) -> int:
        return 1

    @property
    def identity(self) -> Mapping[str, object]:
        return {"version": 1, "up": self.up, "size": PICTURE_SIZE}

    @contextmanager
    def open(self, arrays: ArrayStore) -> Iterator[RunStage]:  # noqa: ARG002 - the protocol's
        yield self._run

    def _run(self, inputs: ShapeInputs) -> StageResult:
        from partwise.render.face_picture import face_id_image  # loads what drivers can do without

        mesh = remesh.working_mesh(inputs)
        picture = face_id_image(mesh, self.up)
        arrays = {"face_ids": picture.face_ids, "shading": picture.shading}
        return StageResult(arrays, {"mesh_hash": mesh.content_hash()})
