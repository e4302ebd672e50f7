"""A workspace to put load on: a large synthetic catalog, people with tokens, and meshes of what is claimed first."""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from sqlalchemy import select

from partwise.mesh import TriMesh
from partwise.simulate.collection import shape_seed, simulate_shape
from partwise.store import tables as t
from partwise.store.block_kinds import MESH
from partwise.store.engine import connect_engine, parsed_url, reading
from partwise.store.meshes import mesh_arrays
from partwise.store.records import NewBlock, NewMesh, NewModel, NewShape, NewStageRun, NewToken, Role
from partwise.workspace.segmentations import MESH as MESH_STAGE
from partwise.workspace.workspace import Workspace, init_collection, open_workspace
from partwise_cli.bench.load_rows import N_PARTS, RowsRequest, fill_rows

COLLECTION = "load"
N_FACES = 10_000
_BLOCK_SHAPES = 32
_TOKEN_TTL = timedelta(days=1)


@dataclass(frozen=True, slots=True)
class Person:
    """Somebody who may come in. secret : of their token, good for a day."""

    person_id: int
    secret: str


@dataclass(frozen=True, slots=True)
class LoadedWorkspace:
    """Where the load goes. database_url : of its catalog. n_faces : of every mesh."""

    path: Path
    database_url: str
    collection_id: int
    people: tuple[Person, ...]
    n_shapes: int
    n_faces: int


def make_workspace(
    path: Path,
    database_url: str,
    n_shapes: int,
    n_people: int,
    n_own_meshes: int,
    seed: int,
    n_faces: int = N_FACES,
) -> LoadedWorkspace:
    """Fills an empty folder and an empty database. The first `n_own_meshes` of the queue have a mesh each, of one
    simulated chair in as many sizes; all others share one, as their surfaces are never asked for.
    """
    collection = init_collection(path, COLLECTION, [f"part {n}" for n in range(1, N_PARTS + 1)], {"train_after": 0})
    chair = simulate_shape("chairs", shape_seed("chairs", seed, 0), "chair", n_faces=n_faces).mesh
    engine = connect_engine(parsed_url(database_url))
    with open_workspace(path) as workspace:
        people = _people(workspace, n_people)
        block_id = _publish_shared(workspace, collection.id, chair)
        model = workspace.catalog.save_model(NewModel(collection.id, {}, "models/none.safetensors", ()))
        request = RowsRequest(
            collection.id,
            collection.schema_version,
            n_shapes,
            tuple(person.person_id for person in people),
            model.id,
            chair.content_hash(),
            chair.n_faces,
            block_id,
            seed,
        )
        try:
            fill_rows(engine, request)
            with reading(engine) as connection:
                place = t.queue_rank.c
                first = select(place.shape_id).order_by(place.rank).limit(n_own_meshes)
                ids = list(connection.execute(first.where(place.collection_id == collection.id)).scalars())
        finally:
            engine.dispose()
        _publish_own(workspace, chair, ids)
    return LoadedWorkspace(path, database_url, collection.id, people, n_shapes, chair.n_faces)


def _people(workspace: Workspace, n_people: int) -> tuple[Person, ...]:
    until = datetime.now(UTC) + _TOKEN_TTL
    ids = [workspace.catalog.add_person(f"person {n:04d}").id for n in range(n_people)]
    tokens = (NewToken(person_id, Role.ANNOTATOR, until) for person_id in ids)
    return tuple(
        Person(person_id, workspace.catalog.issue_token(new, "bench").secret)
        for person_id, new in zip(ids, tokens, strict=True)
    )


def _publish_shared(workspace: Workspace, collection_id: int, mesh: TriMesh) -> int:
    """The mesh of a shape beside the others, whose block they share; the block's id."""
    shape = workspace.catalog.add_shapes(collection_id, [NewShape("first.off", "0" * 64, ".off")])[0]
    name = _publish(workspace, {shape.shape_id: mesh})
    return workspace.catalog.block(name).id


def _publish_own(workspace: Workspace, mesh: TriMesh, shape_ids: list[int]) -> None:
    for start in range(0, len(shape_ids), _BLOCK_SHAPES):
        some = shape_ids[start : start + _BLOCK_SHAPES]
        sizes = 1.0 + 1e-3 * np.arange(start + 1, start + 1 + len(some))
        _publish(
            workspace,
            {shape_id: TriMesh(mesh.vertices * size, mesh.faces) for shape_id, size in zip(some, sizes, strict=True)},
        )


def _publish(workspace: Workspace, meshes: dict[int, TriMesh]) -> str:
    address = workspace.arrays.write_block(MESH, [mesh_arrays(mesh) for mesh in meshes.values()])
    made = [
        NewMesh(shape_id, mesh.content_hash(), mesh.n_vertices, mesh.n_faces, row)
        for row, (shape_id, mesh) in enumerate(meshes.items())
    ]
    runs = [NewStageRun(each.shape_id, MESH_STAGE, "own", each.row) for each in made]
    block = NewBlock(address.name, MESH.name, address.n_shapes, address.n_bytes, address.checksum)
    workspace.catalog.publish_block(block, runs, meshes=made)
    return address.name
