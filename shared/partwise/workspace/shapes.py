"""Reading shapes: all of a collection page by page, one by name, and their stored meshes."""

from collections.abc import Iterator

from partwise.errors import ConflictError, NotFoundError
from partwise.mesh import TriMesh
from partwise.store import meshes
from partwise.store.catalog import ShapeCatalog
from partwise.store.records import Collection, Mesh, Shape, ShapeState
from partwise.workspace.workspace import Workspace

PAGE = 1000


def pages_of_shapes(
    catalog: ShapeCatalog, collection_id: int, state: ShapeState | None = None
) -> Iterator[list[Shape]]:
    """Every shape of the collection by id, a page at a time, so that memory does not grow with the collection."""
    after = 0
    while page := list(catalog.shapes(collection_id, after=after, limit=PAGE, state=state)):
        yield page
        after = page[-1].id


def all_shapes(catalog: ShapeCatalog, collection_id: int, state: ShapeState | None = None) -> Iterator[Shape]:
    """Every shape of the collection, by id."""
    for page in pages_of_shapes(catalog, collection_id, state):
        yield from page


def find_collection(workspace: Workspace, name: str | None) -> Collection:
    """The collection of this name; without one, the only collection there is.

    Raises
    ------
    NotFoundError : no such collection, none at all, or several and none was named.
    """
    if name is not None:
        return workspace.catalog.get_collection(name)
    collections = workspace.catalog.list_collections()
    if not collections:
        raise NotFoundError(f"{workspace.path} must have a collection but has none; make one with `partwise init`")
    if len(collections) > 1:
        names = ", ".join(collection.name for collection in collections)
        raise NotFoundError(f"a collection must be named as {workspace.path} has {names}; add --collection")
    return collections[0]


def find_shape(workspace: Workspace, collection: Collection, name: str) -> Shape:
    """The shape of a source key, such as `a/b.off`, or of its number.

    Raises
    ------
    NotFoundError : no such shape in the collection.
    """
    if name.isdecimal():
        shape = workspace.catalog.shape(int(name))
        if shape.collection_id != collection.id:
            raise NotFoundError(f"shape {name} is not in collection {collection.name!r}; see `partwise status`")
        return shape
    return workspace.catalog.shape_by_key(collection.id, name)


def shape_mesh(workspace: Workspace, shape: Shape) -> Mesh:
    """The record of the shape's present mesh.

    Raises
    ------
    ConflictError : it has none: it was not preprocessed, or failed.
    """
    found = workspace.catalog.meshes([shape.id])
    if shape.id not in found:
        raise ConflictError(
            f"{shape.source_key} must have a mesh but has none yet; run `partwise preprocess`, then `partwise status`"
        )
    return found[shape.id]


def load_mesh(workspace: Workspace, mesh: Mesh) -> TriMesh:
    """The mesh's vertices and faces, checked against its hash.

    Raises
    ------
    NotFoundError : it is stored nowhere any more.
    StoreError : the store cannot be read, or holds another mesh.
    """
    return meshes.read_mesh(workspace.arrays, mesh)
