"""What a collection is like for the machine: rows in the catalog, where they can be changed later."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, asdict, dataclass, fields
from typing import Any, Literal, get_args

from partwise.errors import ParameterError
from partwise.store.queue_settings import QueueSettings
from partwise.store.records import Collection, JobKind
from partwise.workspace.workspace import Workspace

Axis = Literal["x", "y", "z"]
RemeshPolicy = Literal["auto", "never"]
MIN_WORKING_FACES, MAX_WORKING_FACES = 100, 1_000_000


@dataclass(frozen=True, slots=True)
class CollectionSettings(QueueSettings):
    """A collection's settings, each with its default where the row does not say: the queue's, and these.

    up : the axis that points up in pictures.
    working_faces : faces of the meshes that are described and labelled, where they are remeshed.
    remesh : "auto" remeshes what is not a closed manifold in one piece of usual size; "never" nothing.

    Raises
    ------
    ParameterError : an unknown axis or policy, working_faces outside 100 to 1,000,000, or one of the queue's settings
        out of its range.
    """

    _: KW_ONLY
    up: Axis = "y"
    working_faces: int = 10_000
    remesh: RemeshPolicy = "auto"

    def __post_init__(self) -> None:
        QueueSettings.__post_init__(self)  # by name: a slotted dataclass is not the class that super() would look for
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

    Where the number of labels of a shape changes, a job brings the queue in line.

    Raises
    ------
    ParameterError : a value out of range.
    """
    wanted = CollectionSettings(**{**asdict(settings_of(collection)), **changes})
    values = {name: getattr(wanted, name) for name in changes}
    changed = workspace.catalog.update_collection_settings(collection.id, values)
    if wanted.labels_per_shape != settings_of(collection).labels_per_shape:
        workspace.catalog.enqueue_job(collection.id, JobKind.REFILL)
    return changed
