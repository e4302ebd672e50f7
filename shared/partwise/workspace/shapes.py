"""Reading shapes: all of a collection page by page, one by name, and their stored meshes."""

from collections.abc import Iterator

from partwise.errors import ConflictError, NotFoundError
from partwise.mesh import TriMesh
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
    NotFoundError : no such collection, or several and none was named.
    """
    if name is not None:
        return workspace.catalog.get_collection(name)
    collections = workspace.catalog.list_collections()
    if len(collections) != 1:
        names = ", ".join(c.name for c in collections) or "none"
        raise NotFoundError(f"--collection must be given as the workspace has {len(collections)}: {names}")
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
    meshes = workspace.catalog.meshes([shape.id])
    if shape.id not in meshes:
        raise ConflictError(f"{shape.source_key} has no mesh yet; run `partwise preprocess`, then `partwise status`")
    return meshes[shape.id]


def load_mesh(workspace: Workspace, mesh: Mesh) -> TriMesh:
    """The mesh's vertices and faces, from its block."""
    if mesh.block_name is None or mesh.row is None:
        raise ConflictError(f"mesh {mesh.mesh_hash[:12]} is in no block; run `partwise preprocess` again")
    arrays = workspace.arrays.read_many(mesh.block_name, mesh.row, ("vertices", "faces"))
    return TriMesh(arrays["vertices"], arrays["faces"])
