"""`partwise.toml`: what is wrong in it is named, what is in it is documented and read."""

import ast
import dataclasses
import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest

from partwise.config import (
    DATABASE_VARIABLE,
    STORE_VARIABLE,
    Config,
    MeshConfig,
    Preset,
    StoresConfig,
    TrainConfig,
    WorkersConfig,
    read_config,
)
from partwise.errors import ConfigError, ParameterError
from partwise.learning.recipe import PRESETS, Recipe
from partwise.remesh.parameters import AlphaWrap, ImplicitContour
from partwise.testing.expect import raises
from partwise.workspace.workspace import INITIAL_CONFIG

REPOSITORY = Path(__file__).parents[2]
PAGE = REPOSITORY / "docs" / "configuration.md"
DEFINING = ("config.py", "parameters.py")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "partwise.toml"


def _read(file: Path, text: str, environment: dict[str, str] | None = None) -> Config:
    file.write_text(text)
    return read_config(file, environment or {})


# Reading


def test_an_empty_file_means_the_defaults(file: Path) -> None:
    assert _read(file, "") == Config()


def test_values_are_read(file: Path) -> None:
    config = _read(file, "[workers]\nn_actors = 3\n[describe.shape_diameter]\nn_rays = 9\n[train]\nseed = 7\n")
    assert config.workers.n_actors == 3
    assert config.describe.shape_diameter.n_rays == 9
    assert config.train.seed == 7
    assert config.refine == Config().refine


def test_a_whole_number_will_do_for_a_number(file: Path) -> None:
    deadline = _read(file, "[workers.limits.mesh]\ndeadline_s = 60\n").workers.limits.mesh.deadline_s
    assert (deadline, type(deadline)) == (60.0, float)


def test_arrays_of_values_and_of_tables_are_read(file: Path) -> None:
    text = "[remesh]\nlevels = [8_000, 2_000]\ncontours = [{ n_cells = 32 }, { n_cells = 24, offset_cells = 2 }]\n"
    remesh = _read(file, text + "[[remesh.wraps]]\nalpha_percent = 1\noffset_percent = 0.5\n").remesh
    assert remesh.levels == (8_000, 2_000)
    assert remesh.contours == (ImplicitContour(32), ImplicitContour(24, 2.0))
    assert remesh.wraps == (AlphaWrap(1.0, 0.5),)


def test_an_empty_array_of_attempts_leaves_the_others(file: Path) -> None:
    assert _read(file, "[remesh]\nwraps = []\n").remesh.attempts == (ImplicitContour(128), ImplicitContour(64))


def test_the_environment_wins_over_the_file(file: Path) -> None:
    text = '[stores]\ndatabase_url = "sqlite:///a.sqlite"\narray_url = "a"\n'
    assert _read(file, text).stores == StoresConfig("sqlite:///a.sqlite", "a")
    environment = {DATABASE_VARIABLE: "postgresql://h/n", STORE_VARIABLE: "s3://bucket"}
    assert _read(file, text, environment).stores == StoresConfig("postgresql://h/n", "s3://bucket")


def test_the_process_environment_is_the_usual_one(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(STORE_VARIABLE, "s3://bucket")
    monkeypatch.delenv(DATABASE_VARIABLE, raising=False)
    file.write_text("")
    assert read_config(file).stores == StoresConfig(array_url="s3://bucket")


def test_an_empty_variable_counts_as_unset(file: Path) -> None:
    assert _read(file, "", {DATABASE_VARIABLE: "", STORE_VARIABLE: ""}) == Config()


# What is wrong


def test_a_missing_file_says_how_to_make_one(file: Path) -> None:
    with raises(ConfigError, str(file), "missing", "partwise init"):
        read_config(file, {})


def test_a_folder_in_its_place_is_named(file: Path) -> None:
    file.mkdir()
    with raises(ConfigError, str(file), "readable file", "check its rights"):
        read_config(file, {})


def test_what_is_not_toml_is_named_with_its_line(file: Path) -> None:
    with raises(ConfigError, str(file), "TOML", "line 2", "correct that line"):
        _read(file, "[workers]\nn_actors = \n")


def test_what_is_not_utf8_is_named(file: Path) -> None:
    file.write_bytes(b'[stores]\narray_url = "caf\xe9"\n')
    with raises(ConfigError, str(file), "UTF-8", "byte 25"):
        read_config(file, {})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        # sections and keys
        ("[worker]\nn_actors = 1\n", (": section worker", "did you mean workers?")),
        ("verbose = true\n", (": key verbose (= True)", "known are stores, workers, jobs, mesh")),
        ("workers = 3\n", (": workers must be a section but is 3", "[workers]")),
        ("[workers]\nn_actor = 3\n", ("[workers] key n_actor (= 3)", "did you mean n_actors?")),
        ("[mesh]\nzzz = 3\n", ("[mesh] key zzz (= 3)", "known are max_faces")),
        ("[describe.lightfield]\nx = 1\n", ("[describe] section lightfield", "did you mean light_field?")),
        ("[describe]\nspin_image = 1\n", ("[describe] spin_image must be a section but is 1", "[describe.spin_image]")),
        # types
        ('[workers]\nn_actors = "3"\n', ("[workers] n_actors must be a whole number but is '3'",)),
        ("[workers]\nn_actors = 3.0\n", ("[workers] n_actors must be a whole number but is 3.0",)),
        ("[workers]\nn_actors = true\n", ("[workers] n_actors must be a whole number but is True",)),
        (
            "[workers.limits.mesh]\ndeadline_s = true\n",
            ("[workers.limits.mesh] deadline_s must be a number but is True",),
        ),
        ("[workers.limits.mesh]\ndeadline_s = 2020-01-01\n", ("[workers.limits.mesh] deadline_s must be a number",)),
        ("[stores]\narray_url = 1\n", ("[stores] array_url must be a string in quotes but is 1",)),
        ("[train]\ntune_smoothness = 1\n", ("[train] tune_smoothness must be true or false but is 1",)),
        ('[train]\npreset = "papre"\n', ("[train] preset must be one of paper but is 'papre'",)),
        ("[train]\npreset = [1]\n", ("[train] preset must be one of paper but is [1]",)),
        ('[describe.light_field]\nrenderer = "x"\n', ("[describe.light_field] renderer must be one of auto, gl",)),
        ("[remesh]\nlevels = 5000\n", ("[remesh] levels must be an array but is 5000", "put it in [ ]")),
        ("[remesh]\nlevels = [5000, '1']\n", ("[remesh] levels[1] must be a whole number but is '1'",)),
        ("[remesh]\ncontours = [64]\n", ("[remesh] contours[0] must be { n_cells = …, offset_cells = … } but is 64",)),
        ("[remesh]\nwraps = [{ alpha = 1 }]\n", ("[remesh.wraps[0]] key alpha (= 1)", "known are alpha_percent")),
        ("[remesh]\nwraps = [{ alpha_percent = 1 }]\n", ("[remesh.wraps[0]] offset_percent must be given",)),
        # ranges
        ('[stores]\ndatabase_url = ""\n', ("[stores] database_url", "''")),
        ("[remesh]\nlevels = [5_000, 10_000]\n", ("[remesh] levels must descend but are (5000, 10000)",)),
        ("[remesh]\nwraps = []\ncontours = []\n", ("[remesh] a ladder needs an attempt",)),
        ("[[remesh.wraps]]\nalpha_percent = 1\noffset_percent = 60\n", ("[remesh.wraps[0]] offset_percent must be",)),
        ("[remesh]\ncontours = [{ n_cells = 128 }, { n_cells = 8 }]\n", ("[remesh.contours[1]] n_cells must be 16",)),
        ('[stores]\narray_url = " "\n', ("[stores] array_url", "' '")),
        ("[workers]\nn_actors = -1\n", ("[workers] n_actors must be 0 (one a core) or more but is -1",)),
        ("[workers.limits.describe]\ndeadline_s = 0\n", ("[workers.limits.describe] deadline_s must be more than 0",)),
        ("[workers.limits.remesh]\nmemory_gb = nan\n", ("memory_gb must be more than 0 but is nan",)),
        ("[workers]\nrecycle_after = 0\n", ("[workers] recycle_after must be 1 or more but is 0",)),
        ("[jobs]\npoll_s = 0\n", ("[jobs] poll_s must be more than 0 but is 0.0",)),
        ("[jobs]\npulse_s = -1\n", ("[jobs] pulse_s must be more than 0 but is -1.0",)),
        ("[jobs]\nrank_every_s = 0\n", ("[jobs] rank_every_s must be more than 0 but is 0.0",)),
        ("[jobs]\nlost_after_s = 9\n", ("[jobs] lost_after_s must be 5 × pulse_s (10) or more but is 9.0",)),
        ("[workers]\nmax_attempts = 0\n", ("[workers] max_attempts must be 1 or more but is 0",)),
        ("[workers]\nblock_shapes = 0\n", ("[workers] block_shapes must be 1 to 4096 but is 0",)),
        ("[workers]\nblock_shapes = 4097\n", ("[workers] block_shapes must be 1 to 4096 but is 4097",)),
        ("[mesh]\nmax_faces = 3\n", ("[mesh] max_faces must be 4 or more but is 3",)),
        ("[describe.shape_context]\nn_targets = 0\n", ("[describe.shape_context] n_targets must be at least 1",)),
        ("[describe.shape_context]\nn_angle_bins = 8\n", ("[describe] histograms must be 16 × 16", "[8, 16]")),
        ("[train]\nn_iterations = 0\n", ("[train] n_iterations must be 1 or more but is 0",)),
        ("[train]\nn_snapshots = 0\n", ("[train] n_snapshots must be 1 or more but is 0",)),
        ("[train]\nn_iterations = 7\n", ("[train] n_iterations must be a multiple of n_snapshots (5) but is 7",)),
        ("[train]\nbatch_size = 0\n", ("[train] batch_size must be 1 or more but is 0",)),
        ("[train]\nlearning_rate = 1\n", ("[train] learning_rate must be between 0 and 1 but is 1.0",)),
        ("[train]\nlearning_rate = nan\n", ("[train] learning_rate must be between 0 and 1 but is nan",)),
        ("[train]\nseed = -1\n", ("[train] seed must be 0 or more but is -1",)),
        ("[refine]\nsmoothness = inf\n", ("[refine] smoothness must be finite",)),
        ('[boundary]\nform = "flat"\n', ("[boundary] form must be one of crease, paper but is 'flat'",)),
        ("[boundary]\nangle_weight = 1.5\n", ("[boundary] angle_weight must be in [0, 1] but is 1.5",)),
        ("[refine]\nangle_floor = 1\n", ("[refine] angle_floor must be in (0, 1)",)),
    ],
)
def test_what_is_wrong_is_named_with_file_section_key_and_value(file: Path, text: str, words: tuple[str, ...]) -> None:
    with raises(ConfigError, str(file), *words):
        _read(file, text)


@pytest.mark.parametrize(
    ("kind", "values"),
    [(StoresConfig, {"array_url": ""}), (WorkersConfig, {"n_actors": -1}), (MeshConfig, {"max_faces": 0})],
)
def test_values_are_checked_wherever_they_come_from(kind: type, values: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        kind(**values)


# What belongs together


def test_the_presets_are_those_that_can_be_trained() -> None:
    assert get_args(Preset) == PRESETS


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"n_iterations": 0},
        {"n_iterations": 7},
        {"n_iterations": 10, "n_snapshots": 3},
        {"n_snapshots": 0},
        {"batch_size": 0},
        {"seed": -1},
        {"learning_rate": 0.0},
        {"learning_rate": 1.0},
        {"learning_rate": math.nan},
    ],
)
def test_training_takes_what_its_recipe_takes(values: dict[str, Any]) -> None:
    assert _is_accepted(TrainConfig, values) == _is_accepted(Recipe, values)


def test_defaults_of_training_are_those_of_the_recipe() -> None:
    recipe, train = dataclasses.asdict(Recipe()), dataclasses.asdict(TrainConfig())
    assert {key: train[key] for key in recipe.keys() & train.keys()} == {
        key: recipe[key] for key in recipe.keys() & train.keys()
    }


def _is_accepted(kind: type, values: dict[str, Any]) -> bool:
    try:
        kind(**values)
    except ParameterError:
        return False
    return True


# Documentation and use


def _leaves(kind: type = Config, section: str = "") -> Iterator[tuple[str, str, Any]]:
    """Section, key and default of every value of the tree."""
    tree = kind()
    for each in dataclasses.fields(kind):
        value = getattr(tree, each.name)
        if dataclasses.is_dataclass(value):
            yield from _leaves(type(value), f"{section}.{each.name}".lstrip("."))
        else:
            yield section, each.name, value


def _documented() -> list[tuple[str, str, str]]:
    """Section, key and default of every row of the page's tables."""
    rows, section = [], ""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if heading := re.match(r"#+ \[([\w.]+)\]", line):
            section = heading[1]
        elif row := re.match(r"\| `(\w+)` \| `([^`]+)` \| .+ \| .+ \|$", line):
            rows.append((section, row[1], row[2]))
    return rows


def test_every_key_is_documented_and_nothing_else() -> None:
    assert [row[:2] for row in _documented()] == [leaf[:2] for leaf in _leaves()]


def test_documented_defaults_are_the_defaults() -> None:
    documented = {(section, key): tomllib.loads(f"value = {text}")["value"] for section, key, text in _documented()}
    assert documented == {(section, key): _as_in_toml(default) for section, key, default in _leaves()}


def _as_in_toml(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return dataclasses.asdict(value)
    return [_as_in_toml(item) for item in value] if isinstance(value, tuple) else value


def test_the_documented_example_can_be_read(file: Path) -> None:
    first, second = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
    config = _read(file, first)
    assert (config.stores.array_url, config.workers.n_actors) == ("s3://lab-shapes/chairs", 6)
    assert _read(file, second).remesh.attempts == (AlphaWrap(0.3, 0.2), ImplicitContour(96))


@pytest.mark.parametrize("variable", [DATABASE_VARIABLE, STORE_VARIABLE])
def test_the_variables_are_documented(variable: str) -> None:
    assert f"`{variable}`" in PAGE.read_text(encoding="utf-8")


def _attributes_read() -> set[str]:
    """Names of all attributes that the packages read; where the configuration is defined, only what properties read."""
    names: set[str] = set()
    for package in ("shared/partwise", "workers/partwise_workers", "services"):
        for path in (REPOSITORY / package).rglob("*.py"):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            if path.name not in DEFINING:
                names |= _attributes_in(tree)
            else:
                properties = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
                names |= {name for each in properties if _is_property(each) for name in _attributes_in(each)}
    return names


def _attributes_in(tree: ast.AST) -> set[str]:
    return {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}


def _is_property(function: ast.FunctionDef) -> bool:
    return any(isinstance(each, ast.Name) and each.id == "property" for each in function.decorator_list)


def test_every_key_is_read_somewhere() -> None:
    read = _attributes_read()
    assert [key for _, key, _ in _leaves() if key not in read] == []


def test_every_section_is_read_somewhere() -> None:
    read = _attributes_read()
    assert [each.name for each in dataclasses.fields(Config) if each.name not in read] == []


def test_a_workspaces_first_file_can_be_read(file: Path) -> None:
    assert _read(file, INITIAL_CONFIG) == Config()
