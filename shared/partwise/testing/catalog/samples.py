"""Small catalogs to test on."""

import uuid
from collections.abc import Sequence

import numpy as np

from partwise.store.catalog import Catalog
from partwise.store.records import (
    Collection,
    LabelRevision,
    MeshRole,
    Model,
    NewBlock,
    NewMesh,
    NewModel,
    NewRevision,
    NewShape,
    NewStageRun,
    RevisionKind,
)
from partwise.store.reviews import NewReview, RevisionOrigin

N_FACES = 6


def add_collection(catalog: Catalog, n_shapes: int, name: str = "chairs") -> tuple[Collection, list[int]]:
    """A collection with parts seat (1) and back (2), and the ids of its shapes 0.off, 1.off, …"""
    collection = catalog.create_collection(name, ["seat", "back"])
    new = [NewShape(f"{i}.off", f"source{i}", ".off") for i in range(n_shapes)]
    return collection, [ingested.shape_id for ingested in catalog.add_shapes(collection.id, new)]


def new_block(n_shapes: int, kind: str = "features") -> NewBlock:
    return NewBlock(f"blocks/{kind}/{uuid.uuid4()}", kind, n_shapes, 1_000, "0" * 64)


def publish(catalog: Catalog, shape_ids: Sequence[int], stage: str = "describe", key: str = "k1") -> str:
    """Publish a block in which row i is the i-th shape; returns its name."""
    block = new_block(len(shape_ids))
    catalog.publish_block(block, [NewStageRun(shape_id, stage, key, row) for row, shape_id in enumerate(shape_ids)])
    return block.name


def mesh_hash(shape_id: int, version: int = 1) -> str:
    return f"{shape_id:032x}{version:032x}"


def publish_mesh(catalog: Catalog, shape_id: int, version: int = 1, role: MeshRole = MeshRole.WORKING) -> str:
    """Publish a mesh of `N_FACES` faces for a shape in a block of its own; returns the block's name."""
    block = new_block(1, "mesh")
    runs = [NewStageRun(shape_id, "mesh", f"k{version}", 0)]
    new = NewMesh(shape_id, mesh_hash(shape_id, version), 5, N_FACES, 0, role)
    catalog.publish_block(block, runs, meshes=[new])
    return block.name


def label(
    catalog: Catalog, shape_id: int, kind: RevisionKind = RevisionKind.HUMAN, labels: Sequence[int] = (0, 1, 2, 1, 2, 0)
) -> LabelRevision:
    """Commit labels of a shape whose mesh is published, by an author made on first use."""
    author = next(iter(catalog.list_people()), None) or catalog.add_person("ann")
    return catalog.add_revision(NewRevision(shape_id, mesh_hash(shape_id), kind, author.id, 1, np.array(labels)))


def move(
    catalog: Catalog, parent: LabelRevision, version: int, agreement: float = 1.0, review: NewReview | None = None
) -> LabelRevision:
    """Commit a revision's labels once more, as moved to another of the shape's meshes."""
    origin = RevisionOrigin(parent.mesh_hash, parent.id, agreement)
    moved = NewRevision(
        parent.shape_id,
        mesh_hash(parent.shape_id, version),
        parent.kind,
        parent.author_id,
        parent.schema_version,
        catalog.labels(parent.id),
        parent.id,
        origin,
    )
    return catalog.add_revision(moved, review)


def save_model(catalog: Catalog, collection_id: int) -> Model:
    return catalog.save_model(NewModel(collection_id, {"preset": "paper"}, "models/1.safetensors", ()))
