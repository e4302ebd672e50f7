"""`partwise.toml` as one frozen tree. An unknown key, a wrong type or a value out of range is an error that names it.

Only where things are and how they are computed: collections, parts and people are rows in the catalog.
"""

import difflib
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from partwise.errors import ConfigError, ParameterError
from partwise.features.parameters import DescribeParameters
from partwise.segmentation.parameters import RefinementParameters

CONFIG_FILE = "partwise.toml"
DATABASE_VARIABLE = "PARTWISE_DATABASE_URL"
STORE_VARIABLE = "PARTWISE_STORE_URL"


@dataclass(frozen=True, slots=True)
class StoresConfig:
    """Where the two stores are. Relative locations are inside the workspace; the environment may override both."""

    database_url: str = "sqlite:///catalog.sqlite"
    array_url: str = "arrays"


@dataclass(frozen=True, slots=True)
class WorkersConfig:
    """How work is spread over Ray.

    n_actors : processes that work on one shape each; 0 means one a core.
    deadline_s : seconds that one shape may take before its process is killed.
    max_attempts : tries before a shape that kills or outlasts its process is given up.
    block_shapes : shapes packed into one block of arrays.
    """

    n_actors: int = 0
    deadline_s: float = 600.0
    max_attempts: int = 2
    block_shapes: int = 64

    def __post_init__(self) -> None:
        _require(self.n_actors >= 0, "n_actors", self.n_actors, "0 (one a core) or more")
        _require(self.deadline_s > 0, "deadline_s", self.deadline_s, "more than 0")
        _require(self.max_attempts >= 1, "max_attempts", self.max_attempts, "1 or more")
        _require(1 <= self.block_shapes <= 4096, "block_shapes", self.block_shapes, "1 to 4096")


@dataclass(frozen=True, slots=True)
class MeshConfig:
    """What a mesh must be like to be described as it is. `max_faces` bounds the time and memory of describing it."""

    max_faces: int = 100_000

    def __post_init__(self) -> None:
        _require(self.max_faces >= 4, "max_faces", self.max_faces, "4 or more")


@dataclass(frozen=True, slots=True)
class TrainConfig:
    """How models are trained; the defaults are those of George et al. 2018.

    n_iterations : steps in all. n_snapshots : cosine cycles, one kept model each. learning_rate : at each cycle's start.
    batch_size : faces a step. seed : of weights, batches and the inner validation split.
    tune_smoothness : choose the cut's smoothness on held-out training shapes (3 or more labelled shapes).
    """

    preset: str = "paper"
    n_iterations: int = 5000
    n_snapshots: int = 5
    learning_rate: float = 0.01
    batch_size: int = 512
    seed: int = 0
    tune_smoothness: bool = True


@dataclass(frozen=True, slots=True)
class Config:
    """The whole of `partwise.toml`."""

    stores: StoresConfig = field(default_factory=StoresConfig)
    workers: WorkersConfig = field(default_factory=WorkersConfig)
    mesh: MeshConfig = field(default_factory=MeshConfig)
    describe: DescribeParameters = field(default_factory=DescribeParameters)
    train: TrainConfig = field(default_factory=TrainConfig)
    refine: RefinementParameters = field(default_factory=RefinementParameters)


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
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} must be TOML but: {error}; correct that line") from error
    config = _parse(Config, table, where=str(path))
    stores = replace(
        config.stores,
        database_url=environment.get(DATABASE_VARIABLE) or config.stores.database_url,
        array_url=environment.get(STORE_VARIABLE) or config.stores.array_url,
    )
    return replace(config, stores=stores)


T = TypeVar("T")


def _parse(kind: type[T], table: Mapping[str, Any], where: str) -> T:
    hints = get_type_hints(kind)
    known = [f.name for f in fields(kind)]  # type: ignore[arg-type] # T is always a dataclass here
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean `{near[0]}`?" if near else f"known keys are {', '.join(known)}"
            raise ConfigError(f"{where}: unknown key `{key}`; {hint}")
        values[key] = _value(hints[key], value, f"{where}: {key}")
    try:
        return kind(**values)
    except ParameterError as error:
        raise ConfigError(f"{where}: {error}") from error


def _value(kind: Any, value: Any, where: str) -> Any:
    if is_dataclass(kind):
        if not isinstance(value, dict):
            raise ConfigError(f"{where} must be a table but is {value!r}; write it as [section]")
        return _parse(kind, value, where)  # type: ignore[arg-type] # is_dataclass narrows to instance | type
    if get_origin(kind) is Literal:
        if value not in get_args(kind):
            raise ConfigError(f"{where} must be one of {', '.join(get_args(kind))} but is {value!r}; correct it")
        return value
    if kind is float and type(value) is int:
        return float(value)
    if type(value) is not kind:
        raise ConfigError(f"{where} must be of type {kind.__name__} but is {value!r}; correct it")
    return value


def _require(holds: bool, name: str, value: object, rule: str) -> None:
    if not holds:
        raise ParameterError(f"{name} must be {rule} but is {value!r}; correct it")
