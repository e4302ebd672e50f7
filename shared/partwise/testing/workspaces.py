"""Put on record in a workspace what the stages would, from arrays that a test hands in: quick, and without Ray."""

import hashlib
from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float, UInt16

from partwise.geometry.faces import face_areas
from partwise.io.off import format_off
from partwise.mesh import TriMesh
from partwise.render.face_picture import face_id_image
from partwise.selection.acquisition import mean_entropy, mean_entropy_by_area
from partwise.store.array_store import BlockAddress
from partwise.store.block_kinds import EVALUATION, FEATURES, MESH, N_BINS, N_LIGHT_FIELD, PICTURE, REFINEMENT, REMESH
from partwise.store.blocks import BlockKind
from partwise.store.levels import remeshed_arrays
from partwise.store.meshes import mesh_arrays
from partwise.store.records import (
    Collection,
    MeshRole,
    Model,
    NewBlock,
    NewMesh,
    NewModel,
    NewScore,
    NewShape,
    NewStageRun,
)
from partwise.workspace import segmentations as stage
from partwise.workspace.choices import ScoreName
from partwise.workspace.ingest import source_object
from partwise.workspace.shapes import load_mesh
from partwise.workspace.workspace import Workspace

N_WORKING_FACES = 10_000


def ingest(workspace: Workspace, collection: Collection, meshes: Mapping[str, TriMesh]) -> dict[str, int]:
    """Ingests meshes by source key, as OFF files; returns their shapes' ids by source key."""
    batch = []
    for source_key, mesh in meshes.items():
        data = format_off(mesh)
        new = NewShape(source_key, hashlib.sha256(data).hexdigest(), ".off")
        workspace.arrays.put_bytes(source_object(new.source_hash, new.source_suffix), data)
        batch.append(new)
    return {done.source_key: done.shape_id for done in workspace.catalog.add_shapes(collection.id, batch)}


def publish_meshes(
    workspace: Workspace, meshes: Mapping[int, TriMesh], key: str = "mesh-1", role: MeshRole = MeshRole.WORKING
) -> str:
    """Publishes the mesh of each shape, by id, in one block; returns its name."""
    address = workspace.arrays.write_block(MESH, [mesh_arrays(mesh) for mesh in meshes.values()])
    made = [
        NewMesh(shape_id, mesh.content_hash(), mesh.n_vertices, mesh.n_faces, row, role)
        for row, (shape_id, mesh) in enumerate(meshes.items())
    ]
    runs = [
        NewStageRun(mesh.shape_id, stage.MESH, key, mesh.row, summary={"mesh_hash": mesh.mesh_hash}) for mesh in made
    ]
    workspace.catalog.publish_block(_row(address, MESH), runs, meshes=made)
    return address.name


def publish_remeshed(workspace: Workspace, meshes: Mapping[int, TriMesh], key: str = "remesh-1") -> str:
    """Publishes the mesh of each shape, by id, as the working mesh, taken as it is, in one block; returns its name."""
    made = [remeshed_arrays(mesh, [(N_WORKING_FACES, None)]) for mesh in meshes.values()]
    address = workspace.arrays.write_block(REMESH, made)
    new = [
        NewMesh(shape_id, mesh.content_hash(), mesh.n_vertices, mesh.n_faces, row)
        for row, (shape_id, mesh) in enumerate(meshes.items())
    ]
    runs = [
        NewStageRun(mesh.shape_id, stage.REMESH, key, mesh.row, summary={"mesh_hash": mesh.mesh_hash}) for mesh in new
    ]
    workspace.catalog.publish_block(_row(address, REMESH), runs, meshes=new)
    return address.name


def publish_features(
    workspace: Workspace, shape_ids: Sequence[int], rng: np.random.Generator, key: str = "describe-1"
) -> str:
    """Publishes random descriptors of shapes that have meshes, in one block; returns its name."""
    meshes = workspace.catalog.meshes(shape_ids)
    address = workspace.arrays.write_block(FEATURES, [_features(meshes[i].n_faces, rng) for i in shape_ids])
    runs = [
        NewStageRun(shape_id, stage.DESCRIBE, key, row, summary={"mesh_hash": meshes[shape_id].mesh_hash})
        for row, shape_id in enumerate(shape_ids)
    ]
    workspace.catalog.publish_block(_row(address, FEATURES), runs)
    return address.name


def save_model(workspace: Workspace, collection: Collection) -> Model:
    """Puts a model on record that has no weights."""
    return workspace.catalog.save_model(NewModel(collection.id, {"train_s": 0.0}, "models/none.safetensors", ()))


def publish_evaluation(
    workspace: Workspace,
    model: Model,
    part_ids: Sequence[int],
    probabilities: Mapping[int, Float[np.ndarray, "m k"]],
    key: str = "evaluate-1",
) -> str:
    """Publishes (m, k) probabilities of each shape, by id, and the scores they have; returns the block's name."""
    ids = np.array(part_ids, dtype=np.uint16)
    made = [{"probabilities": p.astype(np.float16), "part_ids": ids} for p in probabilities.values()]
    address = workspace.arrays.write_block(EVALUATION, made)
    runs, scores = [], []
    for row, (shape_id, p) in enumerate(probabilities.items()):
        mesh = workspace.catalog.meshes([shape_id])[shape_id]
        areas = face_areas(load_mesh(workspace, mesh))
        entropy, by_area = float(mean_entropy(p)), float(mean_entropy_by_area(p, areas))
        share = np.bincount(np.argmax(p, axis=1), areas, minlength=len(ids)) / areas.sum()
        summary = {
            "area_share": {str(part): float(s) for part, s in zip(part_ids, share, strict=True)},
            "model_version": model.version,
            "mesh_hash": mesh.mesh_hash,
        }
        runs.append(NewStageRun(shape_id, stage.EVALUATE, key, row, summary=summary))
        scores.append(NewScore(shape_id, model.id, ScoreName.ENTROPY, entropy))
        scores.append(NewScore(shape_id, model.id, ScoreName.ENTROPY_BY_AREA, by_area))
    workspace.catalog.publish_block(_row(address, EVALUATION), runs, scores)
    return address.name


def publish_refinement(
    workspace: Workspace, model: Model, labels: Mapping[int, UInt16[np.ndarray, " m"]], key: str = "refine-1"
) -> str:
    """Publishes refined part ids of each shape, by id; returns the block's name."""
    address = workspace.arrays.write_block(REFINEMENT, [{"labels": made} for made in labels.values()])
    meshes = workspace.catalog.meshes(list(labels))
    runs = [
        NewStageRun(
            shape_id,
            stage.REFINE,
            key,
            row,
            summary={"model_version": model.version, "mesh_hash": meshes[shape_id].mesh_hash},
        )
        for row, shape_id in enumerate(labels)
    ]
    workspace.catalog.publish_block(_row(address, REFINEMENT), runs)
    return address.name


def publish_picture(workspace: Workspace, shape_id: int, mesh: TriMesh, key: str = "k1") -> None:
    """What stage `picture` leaves of a mesh."""
    picture = face_id_image(mesh)
    address = workspace.arrays.write_block(PICTURE, [{"face_ids": picture.face_ids, "shading": picture.shading}])
    summary = {"mesh_hash": mesh.content_hash()}
    workspace.catalog.publish_block(_row(address, PICTURE), [NewStageRun(shape_id, "picture", key, 0, summary=summary)])


def _features(n_faces: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    def histograms() -> np.ndarray:
        return rng.integers(0, 256, (n_faces, N_BINS), dtype=np.uint8)

    return {
        "shape_context": histograms(),
        "shape_context_scale": np.asarray(np.float32(1)),
        "spin_image": histograms(),
        "spin_image_scale": np.asarray(np.float32(1)),
        "shape_diameter": rng.random(n_faces, dtype=np.float32),
        "light_field": rng.integers(0, 256, N_LIGHT_FIELD, dtype=np.uint8),
    }


def _row(address: BlockAddress, kind: BlockKind) -> NewBlock:
    return NewBlock(address.name, kind.name, address.n_shapes, address.n_bytes, address.checksum)
