"""A simulated person at work: the target is reached, the log replays, and the cost is what the log says."""

from datetime import timedelta
from itertools import pairwise

import numpy as np
import pytest

from partwise.errors import LabelError, ParameterError
from partwise.labels.operations import Assign, Delta, DeltaSource, Paint, SegmentWide, Undo
from partwise.labels.replay import replay
from partwise.labels.stroke_json import log_from_json, log_to_json
from partwise.mesh import TriMesh
from partwise.simulate.annotator.motor import MotorModel, Tool
from partwise.simulate.annotator.session import OPENED_AT, Equipment, annotate
from partwise.simulate.annotator.sight import Sight

STROKES = (Tool.PAINT, Tool.PATCHES, Tool.SEGMENT_WIDE)
WAYS = [(Tool.PAINT,), STROKES, (Tool.PAINT, Tool.BOUNDARY_REFINEMENT), (*STROKES, Tool.BOUNDARY_REFINEMENT)]
ALLOWED = {Tool.PAINT: Paint, Tool.PATCHES: Assign, Tool.SEGMENT_WIDE: SegmentWide, Tool.BOUNDARY_REFINEMENT: Delta}


def work(desk, *tools, seed=0, start=None, **options):
    equipment = desk.equipped(*tools, **options)
    return annotate(desk.mesh, desk.sight, desk.schema, equipment, np.random.default_rng(seed), start)


@pytest.fixture(scope="module")
def ragged(desk):
    """The truth with every tenth of the shape along its longest side swapped: five wrong bands."""
    band = np.floor(10 * (desk.sight.points[:, 0] - desk.sight.points[:, 0].min())).astype(int)
    return np.where(band % 4 == 1, 3 - desk.belongs, desk.belongs)


@pytest.mark.parametrize("tools", WAYS)
def test_the_target_is_reached_with_the_tools_allowed_alone(desk, tools):
    made = work(desk, *tools, target=0.97)
    assert desk.sight.right_share(made.labels) >= 0.97
    kinds = {type(stroke.operation) for stroke in made.log.strokes}
    assert kinds <= {ALLOWED[tool] for tool in tools} | {Undo}


@pytest.mark.parametrize("tools", WAYS)
def test_the_log_replays_to_the_labels(desk, tools):
    made = work(desk, *tools)
    log = log_from_json(log_to_json(made.log))
    np.testing.assert_array_equal(replay(desk.mesh, np.zeros(desk.mesh.n_faces, np.uint16), log), made.labels)


def test_the_share_right_is_known_after_each_stroke(desk):
    made = work(desk, *STROKES, Tool.BOUNDARY_REFINEMENT)
    blank = np.zeros(desk.mesh.n_faces, np.uint16)
    shares = [
        desk.sight.right_share(replay(desk.mesh, blank, made.log.prefix(n + 1))) for n in range(len(made.log.strokes))
    ]
    assert list(made.right) == pytest.approx(shares)


def test_a_start_is_the_first_stroke_and_what_is_wrong_in_it_is_corrected(desk, ragged):
    made = work(desk, *STROKES, start=ragged)
    first = made.log.strokes[0].operation
    assert isinstance(first, Delta)
    assert first.source is DeltaSource.START_FROM
    assert made.begun_with == pytest.approx(desk.sight.right_share(ragged)) == made.right[0]
    assert made.right[-1] >= 0.97 > made.begun_with


def test_a_start_that_is_good_enough_takes_no_stroke(desk):
    made = work(desk, *STROKES, start=desk.belongs)
    assert (made.cost().strokes, made.cost().clicks) == (0, 1)


def test_the_same_seed_gives_the_same_log_and_another_another(desk):
    first, again, other = (work(desk, *STROKES, seed=seed).log for seed in (1, 1, 2))
    assert first == again
    assert first != other


def test_with_and_without_refinement_agree_until_it_is_first_pressed(desk):
    plain, refined = (work(desk, *tools).log.strokes for tools in (WAYS[0], WAYS[2]))
    first = next(n for n, stroke in enumerate(refined) if isinstance(stroke.operation, Delta))
    assert first > 0
    assert plain[:first] == refined[:first]


def test_time_goes_on_and_nobody_is_idle(desk):
    made = work(desk, Tool.PAINT)
    times = [OPENED_AT, *(stroke.at for stroke in made.log.strokes)]
    assert all(timedelta() < later - earlier <= timedelta(seconds=30) for earlier, later in pairwise(times))
    assert made.cost().n_idle_gaps == 0
    assert made.cost().active_s == pytest.approx((times[-1] - OPENED_AT).total_seconds())


def test_what_made_things_worse_is_taken_back_at_once(desk):
    made = work(desk, Tool.PAINT, motor=MotorModel(aim=0.4), max_strokes=60)  # a shaky hand
    shares = [0.0, *made.right]
    kinds = [type(stroke.operation) for stroke in made.log.strokes]
    assert Undo in kinds
    for n, kind in enumerate(kinds):
        if shares[n + 1] < shares[n]:
            assert kinds[n + 1] is Undo
        if kind is Undo:
            assert shares[n + 1] == pytest.approx(shares[n - 1])


def test_refinement_that_makes_things_worse_is_taken_back_and_tried_less_often(desk):
    equipment = Equipment({Tool.PAINT, Tool.BOUNDARY_REFINEMENT}, refine=lambda labels: np.full_like(labels, 2))
    made = annotate(desk.mesh, desk.sight, desk.schema, equipment, np.random.default_rng(0))
    kinds = [type(stroke.operation) for stroke in made.log.strokes]
    pressed = [n for n, kind in enumerate(kinds) if kind is Delta]
    assert pressed
    assert all(kinds[n + 1] is Undo for n in pressed)
    between = [kinds[a:b].count(Paint) for a, b in pairwise(pressed)]
    assert between == sorted(between)
    assert made.right[-1] >= 0.97


def test_a_person_gives_up_after_so_many_strokes(desk):
    made = work(desk, Tool.PAINT, max_strokes=2)
    assert made.cost().strokes == 2
    assert made.n_strokes_to(0.97) is None
    assert made.cost(0.97) == made.cost()


def test_cost_up_to_a_target_is_that_of_the_log_until_then(desk):
    made = work(desk, Tool.PAINT)
    n = made.n_strokes_to(0.5)
    assert n is not None
    assert made.right[n - 1] >= 0.5 > max(made.right[: n - 1], default=0.0)
    assert made.cost(0.5).clicks == n
    assert made.cost(0.5).active_s < made.cost().active_s


def test_where_nobody_knows_what_belongs_nothing_counts(desk):
    unknown = np.where(desk.sight.points[:, 0] > 0.1, 0, desk.belongs)
    sight = Sight.of(desk.mesh, unknown)
    made = annotate(desk.mesh, sight, desk.schema, desk.equipped(Tool.PAINT, target=0.9), np.random.default_rng(0))
    assert sight.right_share(made.labels) >= 0.9


def test_refuses_sight_of_another_mesh(desk):
    other = Sight.of(*_half(desk))
    with pytest.raises(LabelError, match="another mesh"):
        annotate(desk.mesh, other, desk.schema, desk.equipped(Tool.PAINT), np.random.default_rng(0))


def test_refuses_a_start_of_another_mesh_or_with_unknown_parts(desk):
    for start, message in ((desk.belongs[1:], "one mesh"), (desk.belongs + 1, "part of the schema")):
        with pytest.raises(LabelError, match=message):
            work(desk, Tool.PAINT, start=start)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tools": {Tool.BOUNDARY_REFINEMENT}}, "makes strokes"),
        ({"tools": {Tool.PATCHES}}, "patches must come with"),
        ({"tools": {Tool.PAINT}, "patches": [np.zeros(3, int)]}, "patches must come with"),
        ({"tools": {Tool.PAINT, Tool.BOUNDARY_REFINEMENT}}, "boundary_refinement must come with"),
        ({"tools": {Tool.PAINT}, "refine": lambda labels: labels}, "boundary_refinement must come with"),
        ({"tools": {Tool.PAINT}, "target": 0.0}, "target"),
        ({"tools": {Tool.PAINT}, "target": 1.1}, "target"),
        ({"tools": {Tool.PAINT}, "max_strokes": 0}, "max_strokes"),
        ({"tools": {Tool.PAINT}, "choice_spread": -1.0}, "choice_spread"),
    ],
)
def test_refuses_equipment_that_cannot_be(options, message):
    with pytest.raises(ParameterError, match=message):
        Equipment(**options)


def _half(desk):
    half = desk.mesh.n_faces // 2
    return TriMesh(desk.mesh.vertices, desk.mesh.faces[:half]), desk.belongs[:half]
