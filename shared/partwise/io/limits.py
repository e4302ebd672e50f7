"""How large a mesh file may be before it is refused rather than read."""

from dataclasses import dataclass

from partwise.errors import FileFormatError, ParameterError

MIB = 1024 * 1024


@dataclass(frozen=True, slots=True)
class ReadLimits:
    """Upper bounds on one mesh file, both inclusive.

    max_bytes : size of the file.
    max_faces : triangles, after polygons are triangulated and instances are placed.
    """

    max_bytes: int = 512 * MIB
    max_faces: int = 5_000_000

    def __post_init__(self) -> None:
        for name in ("max_bytes", "max_faces"):
            if getattr(self, name) < 1:
                raise ParameterError(f"{name} must be at least 1 but is {getattr(self, name)}; raise it")

    @property
    def max_vertices(self) -> int:
        """As many as the most faces could use."""
        return 3 * self.max_faces

    @property
    def max_values(self) -> int:
        """Numbers that a table of a text file may have: corners, colours, coordinates of textures, and then some."""
        return 20 * self.max_faces

    def check_bytes(self, n_bytes: int) -> None:
        """Raises FileFormatError when the file is too large to be read."""
        if n_bytes > self.max_bytes:
            raise FileFormatError(
                f"a mesh file may have {self.max_bytes} bytes but this has {n_bytes}; decimate it or raise max_bytes"
            )

    def check_vertices(self, n_vertices: int) -> None:
        """Raises FileFormatError when there are more vertices than `max_vertices`; called as `check_faces` is."""
        if n_vertices > self.max_vertices:
            raise FileFormatError(
                f"{self.max_faces} faces can use {self.max_vertices} vertices but this mesh has {n_vertices}; "
                "drop unused ones or raise max_faces"
            )

    def check_faces(self, n_faces: int) -> None:
        """Raises FileFormatError when there are too many faces; called before memory is taken for them."""
        if n_faces > self.max_faces:
            raise FileFormatError(
                f"a mesh may have {self.max_faces} faces but this one has {n_faces}; decimate it or raise max_faces"
            )
