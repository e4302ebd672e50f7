"""Every label format against the suite."""

import numpy as np
import pytest

from partwise.exchange.coco import CocoDataset, coco_shape, read_coco, write_coco
from partwise.exchange.glb_parts import read_glb_parts, write_glb_parts
from partwise.exchange.label_npz import read_npz, write_npz
from partwise.exchange.labels_psb import read_psb_labels, write_psb_labels
from partwise.exchange.named_labels import NamedLabels, to_part_ids
from partwise.exchange.ply_labels import read_ply_labels, write_ply_labels
from partwise.exchange.seg import read_seg, write_seg
from partwise.testing.label_formats import LabelFormat, LabelFormatConformance


def _write_psb(path, described):
    indices = np.array([*range(len(described.parts.ids)), -1])
    ids = np.array([*described.parts.ids, -1])
    order = np.argsort(ids)
    found = indices[order][np.searchsorted(ids[order], described.labels)]
    write_psb_labels(path, NamedLabels(described.parts.names, found))


def _read_psb(path, mesh, parts):
    named = read_psb_labels(path, mesh.n_faces)
    return to_part_ids(named, dict(zip(parts.names, parts.ids, strict=True)), str(path))


SEG = LabelFormat(
    ".seg",
    lambda path, described: write_seg(path, described.labels),
    lambda path, mesh, parts: read_seg(path, mesh.n_faces),
    knows_mesh=False,
)
PSB = LabelFormat("_labels.txt", _write_psb, _read_psb, knows_count=False, knows_mesh=False)
PLY = LabelFormat(
    ".ply",
    lambda path, described: write_ply_labels(path, described.labelled, described.parts.colours()),
    lambda path, mesh, parts: read_ply_labels(path).labels_on(mesh),
)
GLB = LabelFormat(
    ".glb", write_glb_parts, lambda path, mesh, parts: read_glb_parts(path).labelled.labels_on(mesh), read_glb_parts
)
NPZ = LabelFormat(".npz", write_npz, lambda path, mesh, parts: read_npz(path).labelled.labels_on(mesh), read_npz)
COCO = LabelFormat(
    ".json",
    lambda path, described: write_coco(path, CocoDataset(described.parts, (coco_shape("a", described),))),
    lambda path, mesh, parts: read_coco(path).shapes[0].labels_on(mesh),
)


class TestFormats(LabelFormatConformance):
    @pytest.fixture(params=[SEG, PSB, PLY, GLB, NPZ, COCO], ids=lambda found: found.suffix)
    def label_format(self, request):
        return request.param
