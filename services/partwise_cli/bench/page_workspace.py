"""A workspace whose page is measured: very many shapes in the table, all with one large mesh and the same labels."""

from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import Connection, insert, literal, select

from partwise.mesh import TriMesh
from partwise.render.face_picture import face_id_image
from partwise.store import block_kinds
from partwise.store import tables as t
from partwise.store.blocks import BlockKind
from partwise.store.engine import connect_engine, parsed_url, writing
from partwise.store.records import NewBlock
from partwise.workspace.segmentations import EVALUATE, MESH, PICTURE, REFINE
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace, open_workspace
from partwise_cli.bench.load_rows import N_PARTS
from partwise_cli.bench.load_workspace import LoadedWorkspace, make_workspace

_SURE = 0.9
"""Probability of a face's part in the synthetic predictions."""


def make_page_workspace(path: Path, database_url: str, n_shapes: int, n_faces: int, seed: int) -> LoadedWorkspace:
    """Fills an empty folder and an empty database. Every shape that has a surface has the same one, of `n_faces` faces.

    So the service draws a picture for each tile, but reads the same arrays for all of them.
    """
    made = make_workspace(path, database_url, n_shapes, 1, 0, seed, n_faces)
    engine = connect_engine(parsed_url(database_url))
    try:
        with open_workspace(path) as workspace:
            first = workspace.catalog.shapes(made.collection_id, limit=1)[0]
            mesh = load_mesh(workspace, workspace.catalog.mesh(first.id, str(first.mesh_hash)))
            results = _results(mesh)
            blocks = {stage: _published(workspace, kind, arrays) for stage, (kind, arrays) in results.items()}
        summary = {"mesh_hash": first.mesh_hash, "model_version": 1}
        with writing(engine) as connection:
            for stage, block_id in blocks.items():
                _point_to(connection, stage, block_id, summary)
    finally:
        engine.dispose()
    return made


def _results(mesh: TriMesh) -> dict[str, tuple[BlockKind, dict[str, np.ndarray]]]:
    """What the stages would have made of the mesh: parts one above the other."""
    heights = mesh.vertices[mesh.faces][..., 1].mean(axis=1)
    steps = np.quantile(heights, np.linspace(0, 1, N_PARTS + 1)[1:-1])
    labels = (np.digitize(heights, steps) + 1).astype(np.uint16)
    part_ids = np.arange(1, N_PARTS + 1, dtype=np.uint16)
    probabilities = np.where(labels[:, None] == part_ids, _SURE, (1 - _SURE) / (N_PARTS - 1)).astype(np.float16)
    picture = face_id_image(mesh)
    return {
        PICTURE: (block_kinds.PICTURE, {"face_ids": picture.face_ids, "shading": picture.shading}),
        EVALUATE: (block_kinds.EVALUATION, {"probabilities": probabilities, "part_ids": part_ids}),
        REFINE: (block_kinds.REFINEMENT, {"labels": labels}),
    }


def _published(workspace: Workspace, kind: BlockKind, arrays: dict[str, np.ndarray]) -> int:
    """The arrays of one mesh in a block of their own; the block's id."""
    address = workspace.arrays.write_block(kind, [arrays])
    block = NewBlock(address.name, kind.name, address.n_shapes, address.n_bytes, address.checksum)
    workspace.catalog.publish_block(block, [])
    return workspace.catalog.block(address.name).id


def _point_to(connection: Connection, stage: str, block_id: int, summary: dict[str, Any]) -> None:
    """Every shape that has a mesh has the result of the stage in the first row of a block."""
    run = t.stage_run.c
    connection.execute(t.stage_run.delete().where(run.stage == stage))
    made = {
        "shape_id": run.shape_id,
        "stage": literal(stage),
        "key": run.key,
        "status": run.status,
        "attempts": run.attempts,
        "seconds": run.seconds,
        "summary": literal(summary, run.summary.type),
        "block_id": literal(block_id),
        "row": literal(0),
        "finished_at": run.finished_at,
        "is_superseded": run.is_superseded,
    }
    rows = select(*made.values()).where(run.stage == MESH)
    connection.execute(insert(t.stage_run).from_select(list(made), rows))
