"""What a collection is like for the machine: rows in the catalog, where they can be changed later."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal, get_args

from partwise.errors import ParameterError
from partwise.store.records import Collection
from partwise.workspace.workspace import Workspace

Axis = Literal["x", "y", "z"]
RemeshPolicy = Literal["auto", "never"]
MIN_WORKING_FACES, MAX_WORKING_FACES = 100, 1_000_000


@dataclass(frozen=True, slots=True)
class CollectionSettings:
    """A collection's settings, each with its default where the row does not say.

    up : the axis that points up in pictures.
    working_faces : faces of the meshes that are described and labelled, where they are remeshed.
    remesh : "auto" remeshes what is not a closed manifold in one piece of usual size; "never" nothing.

    Raises
    ------
    ParameterError : an unknown axis or policy, or working_faces outside 100 to 1,000,000.
    """

    up: Axis = "y"
    working_faces: int = 10_000
    remesh: RemeshPolicy = "auto"

    def __post_init__(self) -> None:
        for name, known in (("up", get_args(Axis)), ("remesh", get_args(RemeshPolicy))):
            if getattr(self, name) not in known:
                raise ParameterError(
                    f"{name} must be one of {', '.join(known)} but is {getattr(self, name)!r}; choose one of them"
                )
        if not MIN_WORKING_FACES <= self.working_faces <= MAX_WORKING_FACES:
            raise ParameterError(
                f"faces of working meshes must be {MIN_WORKING_FACES:,} to {MAX_WORKING_FACES:,} but are "
                f"{self.working_faces:,}; 10,000 are usual"
            )


def settings_of(collection: Collection) -> CollectionSettings:
    """The collection's settings. Keys that this version does not know are left alone.

    Raises
    ------
    ParameterError : a value out of range.
    """
    known = {each.name for each in fields(CollectionSettings)}
    return CollectionSettings(**{key: value for key, value in collection.settings.items() if key in known})


def change_settings(workspace: Workspace, collection: Collection, changes: Mapping[str, Any]) -> Collection:
    """The collection with these settings changed, the others as they were.

    Raises
    ------
    ParameterError : a value out of range.
    """
    wanted = CollectionSettings(**{**asdict(settings_of(collection)), **changes})
    values = {name: getattr(wanted, name) for name in changes}
    return workspace.catalog.update_collection_settings(collection.id, values)
