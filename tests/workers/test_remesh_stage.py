"""Stage `remesh` by itself, without Ray: attempts and levels in order, passed over where they failed before."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
import trimesh

from partwise.errors import StageRefusedError
from partwise.geometry.manifold import manifold_report
from partwise.mesh import TriMesh
from partwise.remesh.ladder import AttemptResult, Ladder, Level
from partwise.remesh.parameters import AlphaWrap, ImplicitContour, RemeshParameters
from partwise.store.block_kinds import REMESH
from partwise.store.meshes import mesh_arrays
from partwise.store.ragged import ragged_quantities
from partwise.testing.expect import raises
from partwise.workspace.settings import CollectionSettings
from partwise_workers.stage import RunStage, StageResult, stage_key
from partwise_workers.stages.remesh import RemeshStage

PARAMETERS = RemeshParameters(
    wraps=(AlphaWrap(2.5, 0.3), AlphaWrap(3.0, 0.5)),
    contours=(ImplicitContour(32),),
    levels=(2_000, 500),
    max_distance=0.6,
)
SETTINGS = CollectionSettings(working_faces=1_000)


@dataclass
class FakeInputs:
    """Implements `ShapeInputs` for a mesh; notes which steps were begun."""

    mesh: TriMesh
    failed_steps: Mapping[str, str] = field(default_factory=dict)
    refused_steps: Mapping[str, Mapping] = field(default_factory=dict)
    begun: list[str] = field(default_factory=list)
    refused: dict[str, Mapping] = field(default_factory=dict)

    def source(self) -> tuple[bytes, str]:
        raise AssertionError("the stage reads the mesh stage's arrays, not the source")

    def array(self, stage: str, quantity: str) -> np.ndarray:
        assert stage == "mesh"
        return mesh_arrays(self.mesh)[quantity]

    def begin(self, step: str) -> None:
        self.begun.append(step)

    def refuse(self, step: str, record: Mapping) -> None:
        self.refused[step] = json.loads(json.dumps(record))  # as it comes back on the next try


@contextmanager
def opened(settings: CollectionSettings = SETTINGS, parameters: RemeshParameters = PARAMETERS) -> Iterator[RunStage]:
    with RemeshStage.of(parameters, settings).open(arrays=None) as run:
        yield run


def from_trimesh(shape: trimesh.Trimesh) -> TriMesh:
    return TriMesh(np.asarray(shape.vertices), np.asarray(shape.faces))


BALL = from_trimesh(trimesh.creation.icosphere(subdivisions=3))
BOWL = TriMesh(BALL.vertices, BALL.faces[BALL.vertices[BALL.faces].mean(axis=1)[:, 1] < 0.2])
TWO_BALLS = TriMesh(
    np.concatenate([BALL.vertices, BALL.vertices + 4.0]), np.concatenate([BALL.faces, BALL.faces + BALL.n_vertices])
)


@pytest.fixture(scope="module")
def bowl() -> tuple[StageResult, FakeInputs]:
    inputs = FakeInputs(BOWL)
    with opened() as run:
        return run(inputs), inputs


def stored(result: StageResult) -> TriMesh:
    return TriMesh(result.arrays["vertices"], result.arrays["faces"])


def test_a_clean_mesh_is_taken_as_it_is() -> None:
    inputs = FakeInputs(BALL)
    with opened() as run:
        result = run(inputs)
    assert stored(result).content_hash() == BALL.content_hash() == result.summary["original_mesh_hash"]
    assert (result.summary["is_as_is"], result.summary["working_level"]) == (True, None)
    assert inputs.begun == ["level 2000", "level 1000", "level 500"]


def test_a_sheet_gets_the_working_resolution(bowl) -> None:
    result, _ = bowl
    summary = result.summary
    assert abs(stored(result).n_faces - 1_000) <= 50
    assert (summary["is_as_is"], summary["working_level"]) == (False, 1_000)
    assert summary["mesh_hash"] == stored(result).content_hash() != summary["original_mesh_hash"]


def test_the_working_resolution_is_a_level_though_not_configured(bowl) -> None:
    assert [level["n_faces"] for level in bowl[0].summary["levels"]] == [2_000, 1_000, 500]


def test_what_is_stored_is_clean_as_stored(bowl) -> None:
    arrays = bowl[0].arrays
    assert manifold_report(stored(bowl[0])).is_clean
    start = np.zeros(2, dtype=np.int64)
    for n_faces, *size in arrays["level_sizes"].astype(np.int64):
        end = start + size
        if n_faces != arrays["working_level"]:
            level = TriMesh(arrays["level_vertices"][start[0] : end[0]], arrays["level_faces"][start[1] : end[1]])
            assert manifold_report(level).is_clean
        start = end


def test_the_result_fits_its_block(bowl) -> None:
    assert {each.quantity.name for each in ragged_quantities(REMESH, [bowl[0].arrays])} == {
        quantity.name for quantity in REMESH.quantities
    }


def test_the_account_is_json_and_names_what_was_tried(bowl) -> None:
    result, inputs = bowl
    summary = json.loads(json.dumps(result.summary))
    as_is, wrap = summary["attempts"]
    assert (as_is["method"], wrap["method"], wrap["refused"]) == ("as is", "alpha wrap", None)
    assert inputs.begun == ["attempt 0", "level 2000", "level 1000", "level 500"]


def test_steps_that_ended_the_process_are_passed_over_and_recorded() -> None:
    inputs = FakeInputs(BOWL, {"attempt 0": "it ran out of time", "level 500": "it died"})
    with opened() as run:
        result = run(inputs)
    assert inputs.begun == ["attempt 1", "level 2000", "level 1000"]
    assert result.summary["attempts"][1]["refused"] == "it ran out of time"
    assert result.summary["attempts"][1]["parameters"] == {"alpha_percent": 2.5, "offset_percent": 0.3}
    assert [level["absent"] for level in result.summary["levels"]][2] == "it died"


def test_attempts_that_were_refused_before_are_not_made_again_and_keep_their_record() -> None:
    first = FakeInputs(TWO_BALLS)
    with opened() as run:
        with pytest.raises(StageRefusedError):
            run(first)
        assert list(first.refused) == first.begun == ["attempt 0", "attempt 1", "attempt 2"]
        again = FakeInputs(TWO_BALLS, refused_steps=first.refused)
        with pytest.raises(StageRefusedError, match=r"all 3 attempts were refused") as caught:
            run(again)
    assert again.begun == []
    assert json.loads(json.dumps(caught.value.detail["attempts"][1:])) == list(first.refused.values())


def test_a_level_that_was_refused_before_is_not_made_again_and_keeps_its_record() -> None:
    record = {"method": "quadric", "distance": 0.7, "absent": "it is too far", "core_s": 12.5}
    inputs = FakeInputs(BALL, refused_steps={"level 1000": record})
    with opened() as run:
        result = run(inputs)
    assert inputs.begun == ["level 2000", "level 500"]
    assert result.summary["levels"][1] == {"n_faces": 1000, "reached": None, "mesh_hash": None, **record}


def test_without_its_own_level_a_shape_gets_the_next_coarser() -> None:
    with opened() as run:
        result = run(FakeInputs(BOWL, {"level 1000": "it died"}))
    assert result.summary["working_level"] == 500


def test_an_attempt_whose_library_raises_is_refused_and_the_next_one_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    attempt = Ladder.attempt

    def raise_at_first(ladder: Ladder, index: int) -> AttemptResult:
        if index == 0:
            raise RuntimeError("CGAL error: precondition violation!\nExpression: is_valid")
        return attempt(ladder, index)

    monkeypatch.setattr(Ladder, "attempt", raise_at_first)
    with opened() as run:
        result = run(FakeInputs(BOWL))
    refused = [each["refused"] for each in result.summary["attempts"]]
    assert refused[1:] == ["RuntimeError: CGAL error: precondition violation!", None]


def test_a_level_whose_library_raises_is_absent_and_the_others_made(monkeypatch: pytest.MonkeyPatch) -> None:
    level = Ladder.level

    def raise_at_the_second(ladder: Ladder, surface: TriMesh, n_faces: int) -> Level:
        if n_faces == 1_000:
            raise MemoryError("bad allocation")
        return level(ladder, surface, n_faces)

    monkeypatch.setattr(Ladder, "level", raise_at_the_second)
    with opened() as run:
        inputs = FakeInputs(BOWL)
        result = run(inputs)
    assert list(inputs.refused) == ["level 1000"]
    absent = [each["absent"] for each in result.summary["levels"]]
    assert absent == [None, "MemoryError: bad allocation", None]
    assert result.summary["working_level"] == 500


def test_what_no_attempt_can_make_is_refused_with_all_that_was_tried() -> None:
    with (
        opened() as run,
        pytest.raises(StageRefusedError, match=r"all 3 attempts were refused.+50.0% of the") as caught,
    ):
        run(FakeInputs(TWO_BALLS))
    attempts = json.loads(json.dumps(caught.value.detail))["attempts"]
    assert [attempt["method"] for attempt in attempts] == ["as is", "alpha wrap", "alpha wrap", "implicit contour"]


def test_the_nearest_attempt_is_named_in_the_refusal() -> None:
    strict = replace(PARAMETERS, max_distance=0.001)
    with opened(parameters=strict) as run, raises(StageRefusedError, "the nearest", "light-field distance"):
        run(FakeInputs(BOWL))


def test_a_surface_that_rounding_breaks_is_refused() -> None:
    far = TriMesh(BOWL.vertices * 1e-3 + 7e3, BOWL.faces)
    with opened() as run, raises(StageRefusedError, "rounded to float32 it has"):
        run(FakeInputs(far))


@pytest.mark.parametrize("mesh", [TWO_BALLS, BOWL])
def test_never_takes_anything_as_it_is(mesh: TriMesh) -> None:
    with opened(CollectionSettings(remesh="never")) as run:
        inputs = FakeInputs(mesh)
        result = run(inputs)
    assert stored(result).content_hash() == mesh.content_hash()
    assert (inputs.begun, result.summary["attempts"], result.summary["is_as_is"]) == ([], [], True)
    assert {level["absent"] for level in result.summary["levels"]} == {"not asked for"}
    ragged_quantities(REMESH, [result.arrays])


def test_a_try_is_given_to_every_attempt_and_level() -> None:
    assert RemeshStage.of(PARAMETERS, SETTINGS).n_steps == 6
    assert RemeshStage.of(PARAMETERS, CollectionSettings(remesh="never")).n_steps == 1


def test_settings_and_parameters_are_part_of_the_identity() -> None:
    stages = [
        RemeshStage.of(PARAMETERS, SETTINGS),
        RemeshStage.of(PARAMETERS, replace(SETTINGS, working_faces=500)),
        RemeshStage.of(PARAMETERS, replace(SETTINGS, remesh="never")),
        RemeshStage.of(replace(PARAMETERS, max_distance=0.5), SETTINGS),
    ]
    assert len({stage_key(stage, "source") for stage in stages}) == len(stages)


def test_pictures_are_no_part_of_the_identity() -> None:
    upright, lying = (RemeshStage.of(PARAMETERS, replace(SETTINGS, up=up)) for up in ("y", "z"))
    assert stage_key(upright, "source") == stage_key(lying, "source")
