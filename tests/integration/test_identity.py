"""A labelled shape that is preprocessed at another resolution keeps its labels, and everything they rest on."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.exchange.labels_psb import write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.exchange.seg import read_seg
from partwise.features.parameters import LightFieldParameters
from partwise.geometry.faces import face_areas
from partwise.io.write import write_mesh
from partwise.remesh.parameters import AlphaWrap
from partwise.simulate.collection import CATEGORIES, LabelledShape, simulate_shape
from partwise.store.meshes import kept_mesh_key
from partwise.store.records import Collection, LabelRevision, MeshRole, RevisionKind
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export import export_labels
from partwise.workspace.garbage import collect_garbage
from partwise.workspace.ingest import ingest_folder
from partwise.workspace.labelling import commit_labels, import_labels
from partwise.workspace.relabel import MIN_AGREEMENT
from partwise.workspace.settings import change_settings
from partwise.workspace.workspace import Workspace, init_workspace, open_workspace
from partwise_workers.passes import preprocess

pytestmark = pytest.mark.slow

KEY = "table.off"
SHAPE: LabelledShape = simulate_shape("tables", 4, "table", dirty=True, n_faces=1_000)


@dataclass(frozen=True)
class Relabelled:
    """A soup whose file came with labels, which a person confirmed on 2,000 faces before it was remeshed to 1,000."""

    workspace: Workspace
    collection: Collection
    shape_id: int
    imported: LabelRevision
    first: LabelRevision
    confirmed: LabelRevision
    moved: LabelRevision


def unheard(_: object) -> None:
    """A listener for runs whose result is enough."""


@pytest.fixture(scope="module")
def relabelled(local_ray: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Relabelled]:
    root = tmp_path_factory.mktemp("identity")
    (root / "shapes").mkdir()
    write_mesh(SHAPE.mesh, root / "shapes" / KEY)
    write_psb_labels(root / "shapes" / "table_labels.txt", NamedLabels(SHAPE.part_names, SHAPE.labels))
    init_workspace(root / "ws")
    with open_workspace(root / "ws") as opened:
        yield run(quick(opened), root)


def quick(workspace: Workspace) -> Workspace:
    """One actor, a coarse wrap, pictures without a probe of EGL."""
    config = workspace.config
    return replace(
        workspace,
        config=replace(
            config,
            workers=replace(config.workers, n_actors=1),
            describe=replace(config.describe, light_field=LightFieldParameters(renderer="raycast")),
            remesh=replace(config.remesh, wraps=(AlphaWrap(1.0, 0.2),), levels=(2_000, 1_000), min_wrap_faces=2_000),
        ),
    )


def run(workspace: Workspace, root: Path) -> Relabelled:
    settings = {"working_faces": 2_000}
    collection = workspace.catalog.create_collection("tables", CATEGORIES["tables"].part_names, settings)
    ingest_folder(workspace, collection, root / "shapes")
    preprocess(workspace, collection, unheard)
    import_labels(workspace, collection, root / "shapes", RevisionKind.IMPORTED, "simulation")
    shape = workspace.catalog.shape_by_key(collection.id, KEY)
    imported, first = workspace.catalog.revisions(shape.id)
    labels = workspace.catalog.labels(first.id)
    confirmed = commit_labels(workspace, collection, shape, labels, RevisionKind.HUMAN, "ann")
    collection = change_settings(workspace, collection, {"working_faces": 1_000})
    preprocess(workspace, collection, unheard)
    moved = workspace.catalog.revisions(shape.id)[-1]
    return Relabelled(workspace, collection, shape.id, imported, first, confirmed, moved)


def true_share(labels: np.ndarray) -> float:
    """Of the file's area, what has its true part id."""
    areas = face_areas(SHAPE.mesh)
    return float(areas[labels == SHAPE.labels + 1].sum() / areas.sum())


def test_the_shape_has_another_mesh_and_its_labels_are_on_it(relabelled: Relabelled) -> None:
    mesh = relabelled.workspace.catalog.meshes([relabelled.shape_id])[relabelled.shape_id]
    assert mesh.mesh_hash not in (relabelled.imported.mesh_hash, relabelled.confirmed.mesh_hash)
    assert relabelled.moved.mesh_hash == mesh.mesh_hash
    assert 900 <= mesh.n_faces <= 1_000


def test_the_child_is_the_persons_and_says_how_much_came_along(relabelled: Relabelled) -> None:
    moved, confirmed = relabelled.moved, relabelled.confirmed
    assert (moved.parent_id, moved.author_id, moved.kind) == (confirmed.id, confirmed.author_id, RevisionKind.HUMAN)
    assert moved.origin is not None
    assert (moved.origin.source_id, moved.origin.moved_from) == (confirmed.id, confirmed.mesh_hash)
    reviews = relabelled.workspace.catalog.open_reviews(relabelled.collection.id)
    assert [review.revision_id for review in reviews] == ([moved.id] if moved.origin.agreement < MIN_AGREEMENT else [])


def test_what_was_there_before_is_untouched(relabelled: Relabelled) -> None:
    before = [relabelled.imported, relabelled.first, relabelled.confirmed]
    assert relabelled.workspace.catalog.revisions(relabelled.shape_id)[:3] == before
    np.testing.assert_array_equal(relabelled.workspace.catalog.labels(relabelled.imported.id), SHAPE.labels + 1)


def test_every_mesh_that_labels_rest_on_is_kept_for_good(relabelled: Relabelled) -> None:
    collect_garbage(relabelled.workspace, timedelta(0))
    for revision in relabelled.workspace.catalog.revisions(relabelled.shape_id):
        assert relabelled.workspace.arrays.exists(kept_mesh_key(revision.mesh_hash))


def test_preprocessing_again_moves_nothing(relabelled: Relabelled) -> None:
    before = relabelled.workspace.catalog.revisions(relabelled.shape_id)
    preprocess(relabelled.workspace, relabelled.collection, unheard)
    assert relabelled.workspace.catalog.revisions(relabelled.shape_id) == before


def test_the_files_faces_get_their_true_labels_back(relabelled: Relabelled, tmp_path: Path) -> None:
    ws, collection = relabelled.workspace, relabelled.collection
    export_labels(ws, collection, Segmentation.CONFIRMED, ExportFormat.SEG, tmp_path, MeshRole.ORIGINAL)
    share = true_share(read_seg(tmp_path / "table.seg", SHAPE.mesh.n_faces))
    assert share >= 0.98, f"{share:.2%}"
