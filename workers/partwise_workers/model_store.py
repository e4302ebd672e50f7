"""Models in the array store: weights by content, beside the recipe that is also a row in the catalog.

Reading and writing load torch; a driver that only refers to a model does not.
"""

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from partwise.store.array_store import ArrayStore
from partwise.store.records import Model

if TYPE_CHECKING:
    from partwise.learning.model import TrainedModel


@dataclass(frozen=True, slots=True)
class ModelReference:
    """What an actor needs to load a model: where its weights are, and its version for people to read."""

    weights_key: str
    version: int

    @classmethod
    def of(cls, model: Model) -> Self:
        return cls(model.weights_key, model.version)


def write_model(arrays: ArrayStore, model: "TrainedModel") -> str:
    """Stores weights and recipe and returns the weights' key, which is their hash: equal weights, equal key."""
    from partwise.learning.weights import save_model

    files = save_model(model)
    digest = hashlib.sha256(files.recipe.encode() + files.weights).hexdigest()
    key = f"models/{digest}.safetensors"
    arrays.put_bytes(_recipe_key(key), files.recipe.encode())
    arrays.put_bytes(key, files.weights)
    return key


def read_model(arrays: ArrayStore, reference: ModelReference) -> "TrainedModel":
    """The model of a reference; NotFoundError or ParameterError if its files are not there or do not fit."""
    from partwise.learning.weights import ModelFiles, load_model

    recipe = arrays.get_bytes(_recipe_key(reference.weights_key)).decode()
    return load_model(ModelFiles(arrays.get_bytes(reference.weights_key), recipe))


def _recipe_key(weights_key: str) -> str:
    return weights_key.removesuffix(".safetensors") + ".json"
