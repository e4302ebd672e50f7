"""Small catalogs to test on."""

import uuid
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from partwise.errors import NotFoundError
from partwise.labels.encoding import labels_sha256
from partwise.labels.operations import Assign
from partwise.labels.strokes import Stroke
from partwise.store.catalog import Catalog
from partwise.store.records import (
    Collection,
    Confirmation,
    Draft,
    LabelRevision,
    Lease,
    MeshRole,
    Model,
    NewBlindCheck,
    NewBlock,
    NewClaim,
    NewConfirmation,
    NewConsensus,
    NewDraft,
    NewMesh,
    NewModel,
    NewRevision,
    NewShape,
    NewStageRun,
    Person,
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


def ready_shapes(catalog: Catalog, n_shapes: int, name: str = "chairs") -> tuple[Collection, list[int]]:
    """A collection whose shapes all have a mesh and wait in the queue."""
    collection, shape_ids = add_collection(catalog, n_shapes, name)
    for shape_id in shape_ids:
        publish_mesh(catalog, shape_id)
    publish(catalog, shape_ids)
    return collection, shape_ids


def n_waiting(catalog: Catalog, collection: Collection) -> int:
    """How many labels the collection's shapes wait for, free or held."""
    depth = catalog.queue_depth(collection.id)
    return depth.n_free + depth.n_held


def claim(catalog: Catalog, collection: Collection, person: Person, *, is_prefetch: bool = False) -> Lease:
    """The next shape for a person, where there is one."""
    lease = catalog.claim_next(NewClaim(collection.id, person.id, 60.0, 0.999, is_prefetch))
    if lease is None:
        raise NotFoundError("a shape was to be claimed but none is left")
    return lease


def leased_shape(catalog: Catalog) -> tuple[Collection, Lease]:
    """The one shape of a new collection in the hands of a new person."""
    collection, _ = ready_shapes(catalog, 1)
    return collection, claim(catalog, collection, catalog.add_person("ann"))


def blank_draft(catalog: Catalog, lease: Lease) -> Draft:
    """A draft of the leased shape that starts from nothing."""
    blank = labels_sha256(np.zeros(N_FACES, dtype=np.uint16))
    return catalog.open_draft(lease.id, lease.person_id, NewDraft(mesh_hash(lease.shape_id), None, blank, 1))


def strokes(draft: Draft, first: int, n_strokes: int, base_revision: int | None = None) -> list[Stroke]:
    """Strokes of a draft's author, numbered on from `first`."""
    at = datetime(2026, 1, 31, 12, tzinfo=UTC)
    return [
        Stroke(uuid.uuid4(), sequence, base_revision, draft.person_id, at, Assign(((sequence % N_FACES, 1),), 1))
        for sequence in range(first, first + n_strokes)
    ]


def confirm(
    catalog: Catalog,
    lease: Lease,
    labels: Sequence[int] = (1, 1, 1, 2, 2, 2),
    consensus: NewConsensus | None = None,
    blind_check: NewBlindCheck | None = None,
) -> Confirmation:
    """Confirm labels of a leased shape, with one stroke."""
    draft = blank_draft(catalog, lease)
    if not draft.n_strokes:
        catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 1))
    new = NewConfirmation(draft.id, draft.person_id, 1, np.array(labels), 1, consensus, blind_check)
    return catalog.confirm_draft(new)
