"""A trained model as two files: its weights (safetensors) and its recipe (JSON). Nothing is pickled."""

import json
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import safetensors
from safetensors.numpy import load, save

from partwise.errors import FileFormatError, ParameterError
from partwise.learning.model import Snapshot, TrainedModel
from partwise.learning.network import NetworkSpec
from partwise.learning.recipe import recipe_from_dict, recipe_to_dict

FORMAT = "partwise.model"
FORMAT_VERSION = 1


@dataclass(frozen=True, slots=True)
class ModelFiles:
    """weights : a safetensors file, tensors named `<snapshot number>/<parameter>`. recipe : a JSON document."""

    weights: bytes
    recipe: str


def save_model(model: TrainedModel) -> ModelFiles:
    """The model as files. The same model gives the same bytes."""
    tensors = {
        f"{number}/{name}": np.ascontiguousarray(array)
        for number, snapshot in enumerate(model.snapshots)
        for name, array in snapshot.items()
    }
    document = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "network": asdict(model.spec),
        "recipe": recipe_to_dict(model.recipe),
        "part_ids": model.part_ids,
        "input_gains": dict(model.input_gains),
        "history": model.history,
    }
    return ModelFiles(save(tensors), json.dumps(document, indent=1))


def load_model(files: ModelFiles) -> TrainedModel:
    """The inverse of `save_model`.

    Raises
    ------
    FileFormatError : a file is damaged, of another format or version, or the two do not belong together.
    """
    document = _document(files.recipe)
    try:
        network = document["network"]
        return TrainedModel(
            spec=NetworkSpec(
                n_parts=network["n_parts"],
                widths=tuple(network["widths"]),
                hidden=network["hidden"],
                branches=tuple(network["branches"]),
            ),
            recipe=recipe_from_dict(document["recipe"]),
            part_ids=tuple(document["part_ids"]),
            input_gains=document["input_gains"],
            snapshots=_snapshots(files.weights),
            history=tuple((int(t), float(loss)) for t, loss in document["history"]),
        )
    except ParameterError as error:
        raise FileFormatError(f"the model's files do not fit together: {error}") from error
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise FileFormatError(
            f"the model's recipe must have the fields of version {FORMAT_VERSION} but reading it failed with "
            f"{type(error).__name__}: {error}; was it edited by hand?"
        ) from error


def _document(text: str) -> dict[str, Any]:
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise FileFormatError(f"the model's recipe must be JSON but {error}; restore or retrain it") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise FileFormatError(f"the model's recipe must say format {FORMAT} but does not; is it another file?")
    if document.get("version") != FORMAT_VERSION:
        raise FileFormatError(
            f"the model must be of version {FORMAT_VERSION} but is of {document.get('version')!r}; "
            "retrain it or use the version of Partwise that wrote it"
        )
    return document


def _snapshots(weights: bytes) -> tuple[Snapshot, ...]:
    try:
        tensors = load(weights)
    except safetensors.SafetensorError as error:
        raise FileFormatError(
            f"the model's weights must be a safetensors file but {error}; restore or retrain them"
        ) from error
    numbered: dict[int, dict[str, np.ndarray]] = {}
    for key, array in tensors.items():
        number, _, name = key.partition("/")
        numbered.setdefault(int(number), {})[name] = array
    if sorted(numbered) != list(range(len(numbered))):
        raise FileFormatError(f"snapshots must be numbered from 0 but are {sorted(numbered)}; restore or retrain it")
    return tuple(numbered[number] for number in range(len(numbered)))
