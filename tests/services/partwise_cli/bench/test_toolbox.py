"""`partwise bench toolbox`: what it finds in a folder, what it measures, and how it says so."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from partwise.errors import LabelError, NotEnoughDataError, NotFoundError, ParameterError
from partwise.exchange.labels_psb import write_psb_labels
from partwise.exchange.named_labels import NamedLabels
from partwise.exchange.seg import write_seg
from partwise.io.write import write_mesh
from partwise.simulate.collection import simulate_shape
from partwise.testing.meshes import subdivided
from partwise_cli.bench.labelled_folder import labelled_files, sampled, tasks
from partwise_cli.bench.toolbox import Subject, ToolboxRequest, parse_subjects

N_FACES = 1200


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Two simulated mugs and a chair, each category in its folder, and a mesh without labels."""
    root = tmp_path_factory.mktemp("toolbox")
    for category, index in (("mugs", 0), ("mugs", 1), ("chairs", 0)):
        shape = simulate_shape(category, index, "x", n_faces=N_FACES)
        (root / category).mkdir(exist_ok=True)
        write_mesh(shape.mesh, root / category / f"{index}.off")
        write_psb_labels(root / category / f"{index}_labels.txt", NamedLabels(shape.part_names, shape.labels))
    write_mesh(shape.mesh, root / "mugs" / "unlabelled.off")
    return root


def test_categories_are_folders_with_parts_of_their_own(folder):
    files = labelled_files(folder)
    assert [file.name for file in files] == ["chairs/0", "mugs/0", "mugs/1"]
    assert files[1].part_names == ("body", "handle")
    shape = files[1].read()
    np.testing.assert_array_equal(np.unique(shape.truth), [0, 1])


def test_a_folder_without_folders_is_one_category(folder):
    assert [file.name for file in labelled_files(folder / "mugs")] == ["0", "1"]


def test_the_limit_is_for_each_category(folder):
    files = labelled_files(folder)
    assert [file.name for file in sampled(files, 1)] == ["chairs/0", "mugs/0"]
    assert sampled(files, None) == files


def test_refuses_a_folder_that_is_none_or_has_no_labels(folder, tmp_path):
    with pytest.raises(NotFoundError, match="check it"):
        labelled_files(tmp_path / "missing")
    with pytest.raises(NotEnoughDataError, match=r"_labels\.txt"):
        labelled_files(tmp_path)


def test_predictions_are_read_by_category_and_id(folder, tmp_path):
    (file, *_) = labelled_files(folder)
    truth = file.read().truth
    (tmp_path / "predicted" / "chairs").mkdir(parents=True)
    write_seg(tmp_path / "predicted" / "chairs" / "0.seg", np.where(np.arange(len(truth)) < 9, -1, truth + 1))
    (task,) = tasks([file], tmp_path, [])
    assert task.refined is None
    assert task.predicted is not None
    np.testing.assert_array_equal(task.predicted[:9], -1)
    np.testing.assert_array_equal(task.predicted[9:], truth[9:])


def test_refuses_predictions_that_are_missing_or_of_other_parts(folder, tmp_path):
    (file, *_) = labelled_files(folder)
    with pytest.raises(NotFoundError, match="--predictions"):
        list(tasks([file], tmp_path, []))
    (tmp_path / "refined" / "chairs").mkdir(parents=True)
    for part_id in (0, 99):
        write_seg(tmp_path / "refined" / "chairs" / "0.seg", np.full(file.read().mesh.n_faces, part_id))
        with pytest.raises(LabelError, match="part ids must be 1 to"):
            list(tasks([file], tmp_path, []))


def test_subjects_are_named_with_commas_and_come_in_the_usual_order():
    assert parse_subjects("annotator, patches") == (Subject.PATCHES, Subject.ANNOTATOR)
    assert parse_subjects(None) == tuple(Subject)
    with pytest.raises(ParameterError, match="'paint'"):
        parse_subjects("patches,paint")


def test_refuses_a_request_for_nothing_or_beyond_all():
    with pytest.raises(ParameterError, match="something to measure"):
        ToolboxRequest(Path(), subjects=())
    for targets in ((), (0.0,), (0.9, 1.5)):
        with pytest.raises(ParameterError, match="targets"):
            ToolboxRequest(Path(), targets=targets)


def test_everything_comes_in_one_document(folder, invoke):
    result = invoke("bench", "toolbox", folder / "mugs", "--seed", "3", "--json")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["n_shapes"] == dict.fromkeys(("patches", "boundaries", "model", "annotator"), 2)
    assert set(document["core_s"]) == {subject.value for subject in Subject}
    assert set(document["patches"]["accuracy"]) == {"random_walks", "k_means"}
    assert set(document["boundaries"]["means"]) >= {"default", "paper"}
    assert document["annotator"]["n_shapes"] == 2
    assert document["seed"] == document["boundaries"]["seed"] == document["annotator"]["seed"] == 3


def test_the_same_seed_says_the_same(folder, invoke):
    arguments = ("bench", "toolbox", folder, "--only", "annotator", "--limit", "1", "--target", "0.9", "--json")
    first, second = (json.loads(invoke(*arguments).stdout) for _ in range(2))
    assert first["annotator"] == second["annotator"]
    assert first["n_shapes"] == {"annotator": 2}
    assert {row["target"] for row in first["annotator"]["rows"]} == {0.9}


def test_tables_for_people(folder, invoke):
    shown = invoke("bench", "toolbox", folder / "mugs", "--limit", "1").stdout
    for title in ("Area right where each patch", "Boundary refinement", "Model refinement", "Simulated annotator",
                  "Strokes, paired by shape", "Agreement with the truth"):  # fmt: skip
        assert title in shown


def test_a_shape_with_unlabelled_faces_is_left_out_and_named(folder, tmp_path, tetrahedron, invoke):
    mesh = subdivided(subdivided(subdivided(tetrahedron)))
    write_mesh(mesh, tmp_path / "a.off")
    write_psb_labels(tmp_path / "a_labels.txt", NamedLabels(("x",), np.where(np.arange(mesh.n_faces) > 0, 0, -1)))
    result = invoke("bench", "toolbox", tmp_path, "--only", "model")
    assert isinstance(result.exception, NotEnoughDataError)
    for ending in (".off", "_labels.txt"):
        shutil.copy(folder / "mugs" / f"0{ending}", tmp_path / f"b{ending}")
    result = invoke("bench", "toolbox", tmp_path, "--only", "model,annotator", "--json")
    assert json.loads(result.stdout)["n_shapes"] == {"model": 1, "annotator": 1}
    assert result.stderr.count("1 faces have no true part") == 2


def test_a_damaged_file_costs_only_itself(folder, tmp_path, invoke):
    for ending in (".off", "_labels.txt"):
        shutil.copy(folder / "mugs" / f"0{ending}", tmp_path / f"whole{ending}")
        shutil.copy(folder / "mugs" / f"0{ending}", tmp_path / f"cut{ending}")
    (tmp_path / "cut.off").write_bytes(b"OFF\n4 4 0\n0 0 0\n")
    result = invoke("bench", "toolbox", tmp_path, "--only", "model", "--json")
    assert json.loads(result.stdout)["n_shapes"] == {"model": 1}
    assert "cut.off" in result.stderr
