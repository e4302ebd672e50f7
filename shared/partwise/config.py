"""`partwise.toml` as one frozen tree. An unknown key, a wrong type or a value out of range is an error that names it.

Only where things are and how they are computed: collections, parts and people are rows in the catalog. Every key is
explained in docs/configuration.md.
"""

import difflib
import os
import tomllib
from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from partwise.errors import ConfigError, ParameterError
from partwise.features.parameters import DescribeParameters
from partwise.remesh.parameters import RemeshParameters
from partwise.segmentation.parameters import BoundaryParameters, RefinementParameters

CONFIG_FILE = "partwise.toml"
DATABASE_VARIABLE = "PARTWISE_DATABASE_URL"
STORE_VARIABLE = "PARTWISE_STORE_URL"
Preset = Literal["paper"]


@dataclass(frozen=True, slots=True)
class StoresConfig:
    """Where the two stores are. Relative locations are inside the workspace; the environment may override both."""

    database_url: str = "sqlite:///catalog.sqlite"
    array_url: str = "arrays"

    def __post_init__(self) -> None:
        _require(bool(self.database_url.strip()), "database_url", self.database_url, "a database URL")
        _require(bool(self.array_url.strip()), "array_url", self.array_url, "a folder or a store URL")


@dataclass(frozen=True, slots=True)
class StageLimits:
    """What one stage may take of one shape before its process is killed.

    deadline_s : seconds. memory_gb : resident memory of the process, 10^9 bytes, libraries and models included.
    """

    deadline_s: float = 120.0
    memory_gb: float = 4.0

    def __post_init__(self) -> None:
        _require(self.deadline_s > 0, "deadline_s", self.deadline_s, "more than 0")
        _require(self.memory_gb > 0, "memory_gb", self.memory_gb, "more than 0")


@dataclass(frozen=True, slots=True)
class RemeshLimits(StageLimits):
    """Of stage `remesh`: fine alpha wraps of large soups take long."""

    deadline_s: float = 300.0


@dataclass(frozen=True, slots=True)
class DescribeLimits(StageLimits):
    """Of stage `describe`: a mesh of `max_faces` faces fits."""

    deadline_s: float = 600.0


@dataclass(frozen=True, slots=True)
class LimitsConfig:
    """Limits by stage."""

    mesh: StageLimits = field(default_factory=StageLimits)
    remesh: RemeshLimits = field(default_factory=RemeshLimits)
    describe: DescribeLimits = field(default_factory=DescribeLimits)
    picture: StageLimits = field(default_factory=StageLimits)
    evaluate: StageLimits = field(default_factory=StageLimits)
    refine: StageLimits = field(default_factory=StageLimits)


@dataclass(frozen=True, slots=True)
class WorkersConfig:
    """How work is spread over Ray.

    n_actors : processes that work on one shape each; 0 means one a core.
    max_attempts : tries of a stage, or of each of its steps, whose process dies by itself.
    recycle_after : shapes after which a process is ended and replaced.
    block_shapes : shapes packed into one block of arrays.
    limits : what each stage may take of a shape.
    """

    n_actors: int = 0
    max_attempts: int = 2
    recycle_after: int = 200
    block_shapes: int = 64
    limits: LimitsConfig = field(default_factory=LimitsConfig)

    def __post_init__(self) -> None:
        _require(self.n_actors >= 0, "n_actors", self.n_actors, "0 (one a core) or more")
        _require(self.max_attempts >= 1, "max_attempts", self.max_attempts, "1 or more")
        _require(self.recycle_after >= 1, "recycle_after", self.recycle_after, "1 or more")
        _require(1 <= self.block_shapes <= 4096, "block_shapes", self.block_shapes, "1 to 4096")


@dataclass(frozen=True, slots=True)
class JobsConfig:
    """How `partwise work` takes up jobs.

    poll_s : seconds between two looks for work. pulse_s : between two signs of life of a job that is worked on.
    lost_after_s : of silence after which another worker begins a job again; 5 pulses or more.
    rank_every_s : between two rankings of the queue while shapes are evaluated.
    """

    poll_s: float = 1.0
    pulse_s: float = 2.0
    lost_after_s: float = 60.0
    rank_every_s: float = 15.0

    def __post_init__(self) -> None:
        for name in ("poll_s", "pulse_s", "rank_every_s"):
            _require(getattr(self, name) > 0, name, getattr(self, name), "more than 0")
        rule = f"5 × pulse_s ({5 * self.pulse_s:g}) or more"
        _require(self.lost_after_s >= 5 * self.pulse_s, "lost_after_s", self.lost_after_s, rule)


@dataclass(frozen=True, slots=True)
class MeshConfig:
    """Which files are taken. `max_faces` bounds the time and memory of reading and remeshing one."""

    max_faces: int = 1_000_000

    def __post_init__(self) -> None:
        _require(self.max_faces >= 4, "max_faces", self.max_faces, "4 or more")


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How models are trained; the defaults are those of George et al. 2018.

    n_iterations : steps in all. n_snapshots : cosine cycles, one kept model each.
    learning_rate : at each cycle's start. batch_size : faces a step.
    seed : of weights, batches and the inner validation split.
    tune_smoothness : choose the cut's smoothness on held-out training shapes (3 or more labelled shapes).

    The ranges are those of `partwise.learning.recipe.Recipe`, which needs more than may be loaded to read a file.
    """

    preset: Preset = "paper"
    n_iterations: int = 5000
    n_snapshots: int = 5
    learning_rate: float = 0.01
    batch_size: int = 512
    seed: int = 0
    tune_smoothness: bool = True

    def __post_init__(self) -> None:
        for name in ("n_iterations", "n_snapshots", "batch_size"):
            _require(getattr(self, name) >= 1, name, getattr(self, name), "1 or more")
        rule = f"a multiple of n_snapshots ({self.n_snapshots})"
        _require(self.n_iterations % self.n_snapshots == 0, "n_iterations", self.n_iterations, rule)
        _require(0 < self.learning_rate < 1, "learning_rate", self.learning_rate, "between 0 and 1")
        _require(self.seed >= 0, "seed", self.seed, "0 or more")


@dataclass(frozen=True, slots=True)
class Config:
    """The whole of `partwise.toml`."""

    stores: StoresConfig = field(default_factory=StoresConfig)
    workers: WorkersConfig = field(default_factory=WorkersConfig)
    jobs: JobsConfig = field(default_factory=JobsConfig)
    mesh: MeshConfig = field(default_factory=MeshConfig)
    remesh: RemeshParameters = field(default_factory=RemeshParameters)
    describe: DescribeParameters = field(default_factory=DescribeParameters)
    train: TrainConfig = field(default_factory=TrainConfig)
    refine: RefinementParameters = field(default_factory=RefinementParameters)
    boundary: BoundaryParameters = field(default_factory=BoundaryParameters)


def read_config(path: Path, environment: Mapping[str, str] = os.environ) -> Config:
    """Reads `partwise.toml`; `PARTWISE_DATABASE_URL` and `PARTWISE_STORE_URL` in the environment win over it.

    Raises
    ------
    ConfigError : the file is missing or not TOML, or holds an unknown key or a value of the wrong type or range.
    """
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise ConfigError(
            f"a workspace needs {CONFIG_FILE} but {path} is missing; make one with `partwise init`"
        ) from error
    except OSError as error:
        raise ConfigError(f"{path} must be a readable file but: {error.strerror or error}; check its rights") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path} must be UTF-8 but byte {error.start} is not; save it as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{path} must be TOML but: {error}; correct that line") from error
    config = _parse(Config, table, str(path), "")
    stores = replace(
        config.stores,
        database_url=environment.get(DATABASE_VARIABLE) or config.stores.database_url,
        array_url=environment.get(STORE_VARIABLE) or config.stores.array_url,
    )
    return replace(config, stores=stores)


T = TypeVar("T")

_TYPE_NAMES = {int: "a whole number", float: "a number", str: "a string in quotes", bool: "true or false"}


def _parse(kind: type[T], table: Mapping[str, Any], file: str, section: str) -> T:
    """A dataclass of a TOML table; `section` is the table's dotted name, empty for the whole file."""
    hints = get_type_hints(kind)
    of_kind = fields(kind)  # type: ignore[arg-type] # T is always a dataclass here
    known = [each.name for each in of_kind]
    place = f"{file}: [{section}]" if section else f"{file}:"
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in known:
            raise ConfigError(f"{place} {_unknown(key, value, known)}")
        inner = f"{section}.{key}" if section else key
        if is_dataclass(hints[key]):
            if not isinstance(value, dict):
                raise ConfigError(f"{place} {key} must be a section but is {value!r}; write it as [{inner}]")
            values[key] = _parse(hints[key], value, file, inner)
        else:
            values[key] = _value(hints[key], value, file, section, key)
    missing = [each.name for each in of_kind if _is_required(each) and each.name not in values]
    if missing:
        raise ConfigError(f"{place} {missing[0]} must be given but is not; add {missing[0]} = …")
    try:
        return kind(**values)
    except ParameterError as error:
        raise ConfigError(f"{place} {error}") from error


def _is_required(each: Field[Any]) -> bool:
    return each.default is MISSING and each.default_factory is MISSING


def _unknown(key: str, value: object, known: list[str]) -> str:
    what = "section" if isinstance(value, dict) else "key"
    near = difflib.get_close_matches(key, known, n=1)
    hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
    return f"{what} {key} (= {value!r}) must be a known one; {hint}"


def _value(kind: Any, value: Any, file: str, section: str, key: str) -> Any:
    where = f"{file}: [{section}] {key}" if section else f"{file}: {key}"
    if get_origin(kind) is Literal:
        if value not in get_args(kind):
            raise ConfigError(f"{where} must be one of {', '.join(get_args(kind))} but is {value!r}; correct it")
        return value
    if get_origin(kind) is tuple:
        return _values(get_args(kind)[0], value, file, section, key)
    if kind is float and type(value) is int:
        return float(value)
    if type(value) is not kind:
        raise ConfigError(f"{where} must be {_TYPE_NAMES[kind]} but is {value!r}; correct it")
    return value


def _values(kind: Any, value: Any, file: str, section: str, key: str) -> tuple[Any, ...]:
    """A tuple of a TOML array; where `kind` is a dataclass, of an array of tables."""
    if not isinstance(value, list):
        raise ConfigError(f"{file}: [{section}] {key} must be an array but is {value!r}; put it in [ ]")
    holds_tables = is_dataclass(kind)
    if not holds_tables:
        return tuple(_value(kind, item, file, section, f"{key}[{n}]") for n, item in enumerate(value))
    for n, item in enumerate(value):
        if not isinstance(item, dict):
            form = ", ".join(f"{each.name} = …" for each in fields(kind))
            raise ConfigError(f"{file}: [{section}] {key}[{n}] must be {{ {form} }} but is {item!r}; correct it")
    return tuple(_parse(kind, item, file, f"{section}.{key}[{n}]") for n, item in enumerate(value))


def _require(holds: bool, name: str, value: object, rule: str) -> None:
    if not holds:
        raise ParameterError(f"{name} must be {rule} but is {value!r}; correct it")
