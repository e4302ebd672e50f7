"""`Recipe`: everything but the data that decides the weights of a model."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from partwise.errors import ParameterError
from partwise.learning.schedule import snapshot_iterations

PRESETS = ("paper",)


@dataclass(frozen=True, slots=True)
class Recipe:
    """How a network is trained. The defaults are the paper's.

    preset : name of the formulation: "paper" is the only one so far.
    n_iterations, n_snapshots : T and M of the schedule; M divides T.
    learning_rate : α0, at the start of each cycle.
    batch_size : faces a step.
    smoothing : decay of RMSProp's running mean of squared gradients.
    seed : of the initial weights and of the order of faces.

    Raises
    ------
    ParameterError : a value has the wrong type or is outside its range.

    Source: George et al. 2018.
    """

    preset: str = "paper"
    n_iterations: int = 5000
    n_snapshots: int = 5
    learning_rate: float = 0.01
    batch_size: int = 512
    smoothing: float = 0.9
    seed: int = 0

    def __post_init__(self) -> None:
        if self.preset not in PRESETS:
            raise ParameterError(f"preset must be one of {', '.join(PRESETS)} but is {self.preset!r}; name a known one")
        for name in ("n_iterations", "n_snapshots", "batch_size", "seed"):
            _require_integer(name, getattr(self, name), minimum=0 if name == "seed" else 1)
        _require_between("learning_rate", self.learning_rate, 0.0, 1.0)
        _require_between("smoothing", self.smoothing, 0.0, 1.0)
        snapshot_iterations(self.n_iterations, self.n_snapshots)

    @property
    def n_draws(self) -> int:
        """Faces that a whole training looks at, T · batch."""
        return self.n_iterations * self.batch_size


def recipe_to_dict(recipe: Recipe) -> dict[str, Any]:
    """The recipe as a dictionary that JSON and TOML can hold."""
    return asdict(recipe)


def recipe_from_dict(values: Mapping[str, Any]) -> Recipe:
    """The inverse of `recipe_to_dict`; absent keys take their defaults.

    Raises
    ------
    ParameterError : an unknown key, or a value out of range.
    """
    known = [field.name for field in fields(Recipe)]
    unknown = sorted(set(values) - set(known))
    if unknown:
        raise ParameterError(f"a recipe has the keys {', '.join(known)} but also got {', '.join(unknown)}; remove them")
    return Recipe(**values)


def _require_integer(name: str, value: object, minimum: int) -> None:
    if not isinstance(value, int) or isinstance(value, bool) or value < minimum:
        raise ParameterError(f"{name} must be an integer of at least {minimum} but is {value!r}; correct the recipe")


def _require_between(name: str, value: object, low: float, high: float) -> None:
    if not isinstance(value, float) or not low < value < high:
        raise ParameterError(f"{name} must be a float between {low} and {high} but is {value!r}; correct the recipe")
