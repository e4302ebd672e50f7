"""Simulated collections: any number of labelled shapes of a category, each remade from its own seed alone."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Int

from partwise.errors import DegenerateMeshError, LabelError, ParameterError
from partwise.mesh import TriMesh
from partwise.simulate.blueprint import Blueprint
from partwise.simulate.chairs import CHAIR_PARTS, random_chair
from partwise.simulate.lamps import LAMP_PARTS, random_lamp
from partwise.simulate.mugs import MUG_PARTS, random_mug
from partwise.simulate.planes import PLANE_PARTS, random_plane
from partwise.simulate.realise import realise, require_one_piece
from partwise.simulate.soup import realise_as_soup
from partwise.simulate.tables import TABLE_PARTS, random_table

MAX_SHAPES = 1_000_000
MIN_FACES, MAX_FACES = 1_000, 200_000
_USUAL_FACES = (2_000, 20_000)
_N_ATTEMPTS = 12


@dataclass(frozen=True, slots=True)
class Category:
    """What can be simulated under one name: its parts, in the order of label indices, and who draws its shapes."""

    name: str
    part_names: tuple[str, ...]
    draw: Callable[[np.random.Generator], Blueprint]


CATEGORIES: dict[str, Category] = {
    category.name: category
    for category in (
        Category("chairs", CHAIR_PARTS, random_chair),
        Category("tables", TABLE_PARTS, random_table),
        Category("lamps", LAMP_PARTS, random_lamp),
        Category("planes", PLANE_PARTS, random_plane),
        Category("mugs", MUG_PARTS, random_mug),
    )
}


@dataclass(frozen=True, slots=True, eq=False)
class LabelledShape:
    """A mesh with the true part of every face.

    name : unique within its collection. labels : (m,) int64 indices into part_names. seed : what remakes it, see
    `simulate_shape`.

    Raises
    ------
    LabelError : labels of another length than the faces, or outside the part names.
    """

    name: str
    mesh: TriMesh
    labels: Int[np.ndarray, " m"]
    part_names: tuple[str, ...]
    seed: int

    def __post_init__(self) -> None:
        if self.labels.shape != (self.mesh.n_faces,):
            raise LabelError(
                f"labels must have one entry for each of the {self.mesh.n_faces} faces but have shape "
                f"{self.labels.shape}; do they belong to another mesh?"
            )
        if self.labels.min() < 0 or self.labels.max() >= len(self.part_names):
            raise LabelError(
                f"labels must index the {len(self.part_names)} part names but run from {self.labels.min()} to "
                f"{self.labels.max()}; is a part name missing?"
            )


def simulate_collection(
    category: str, n_shapes: int, seed: int, *, dirty: bool = False, n_faces: int | None = None
) -> Iterator[LabelledShape]:
    """Shapes one by one; shape i depends on category, seed, i, dirty and n_faces only. Arguments are checked at once.

    Parameters
    ----------
    category : one of `CATEGORIES`.
    n_shapes : 1 to 1,000,000.
    seed : not negative.
    dirty : soups in place of closed manifolds; the same seed gives the same designs.
    n_faces : faces of every shape (±2 %), 1,000 to 200,000; None draws 2,000 to 20,000 for each.

    Raises
    ------
    ParameterError : an argument outside the above.
    """
    chosen = _category(category)
    if not 1 <= n_shapes <= MAX_SHAPES:
        raise ParameterError(f"a collection has 1 to {MAX_SHAPES} shapes but {n_shapes} were asked for; choose a count")
    _check_faces(n_faces)
    seeds = (shape_seed(category, seed, index) for index in range(n_shapes))
    _check_seed(seed)
    return (
        simulate_shape(category, own, f"{chosen.name[:-1]}-{index:04d}", dirty=dirty, n_faces=n_faces)
        for index, own in enumerate(seeds)
    )


def shape_seed(category: str, seed: int, index: int) -> int:
    """The seed of shape `index` of a collection: an integer below 2**63, spawned from category, seed and index.

    Raises
    ------
    ParameterError : unknown category, or a negative seed.
    """
    _check_seed(seed)
    key = (*_category(category).name.encode(), index)
    state = np.random.SeedSequence(seed, spawn_key=key).generate_state(1, np.uint64)[0]
    return int(state >> np.uint64(1))


def simulate_shape(
    category: str, seed: int, name: str, *, dirty: bool = False, n_faces: int | None = None
) -> LabelledShape:
    """The one shape that `seed` (as recorded in `LabelledShape.seed`) stands for; other arguments as above.

    A design that does not hang together, or cannot be meshed cleanly, is drawn anew from the same seed's next child.

    Raises
    ------
    ParameterError : unknown category, negative seed, or n_faces out of range.
    DegenerateMeshError : a dozen designs failed (n_faces is too low for the category).
    """
    chosen = _category(category)
    _check_seed(seed)
    _check_faces(n_faces)
    failure = ""
    for attempt in range(_N_ATTEMPTS):
        design, meshing = (np.random.default_rng(s) for s in np.random.SeedSequence((seed, attempt)).spawn(2))
        try:
            blueprint = chosen.draw(design)
            wanted = n_faces or _usual_face_count(meshing)
            if dirty:
                # So that clean and dirty shapes of one seed share one design.
                require_one_piece(blueprint)
                mesh, labels = realise_as_soup(blueprint, chosen.part_names, wanted, meshing)
            else:
                mesh, labels = realise(blueprint, chosen.part_names, wanted)
        except DegenerateMeshError as error:
            failure = str(error)
            logging.getLogger(__name__).debug(
                "design rejected", extra={"seed": seed, "attempt": attempt, "why": failure}
            )
            continue
        return LabelledShape(name, mesh, labels, chosen.part_names, seed)
    raise DegenerateMeshError(f"none of {_N_ATTEMPTS} designs for {category} seed {seed} worked; the last: {failure}")


def _usual_face_count(rng: np.random.Generator) -> int:
    """Log-uniform in the usual range."""
    low, high = np.log(_USUAL_FACES)
    return int(np.exp(rng.uniform(low, high)))


def _category(name: str) -> Category:
    try:
        return CATEGORIES[name]
    except KeyError:
        raise ParameterError(f"a category is one of {', '.join(CATEGORIES)} but is {name!r}; choose one") from None


def _check_seed(seed: int) -> None:
    if seed < 0:
        raise ParameterError(f"a seed is not negative but is {seed}; choose 0 or more")


def _check_faces(n_faces: int | None) -> None:
    if n_faces is not None and not MIN_FACES <= n_faces <= MAX_FACES:
        raise ParameterError(
            f"a simulated shape has {MIN_FACES} to {MAX_FACES} faces but {n_faces} were asked for; choose between"
        )
