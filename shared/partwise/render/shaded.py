"""A picture of a mesh with a colour on every face, by ray casting: for reports and contact sheets. Needs no GL.

`shade` looks through the camera once and gives the face and the light of every sample; `coloured` paints them. So a
mesh is shaded once and coloured as often as its labels change.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float32, Int32, UInt8

from partwise.errors import ParameterError
from partwise.geometry.faces import face_normals
from partwise.mesh import TriMesh
from partwise.render.ray_scene import RayScene
from partwise.render.views import fit_unit_sphere

UpAxis = Literal["x", "y", "z", "-x", "-y", "-z"]

THREE_QUARTER = (0.55, 0.42, 1.0)  # right, up, front of the shape: seen from the front right, a little from above
FIELD_OF_VIEW = 0.42  # radians: long enough a lens that proportions stay true
MARGIN = 1.06  # of the shape's extent in the picture
KEY_LIGHT = (-0.45, 0.75, 0.55)  # right, up, towards the camera
KEY_STRENGTH, SKY_STRENGTH, GROUND_STRENGTH = 0.72, 0.56, 0.24
OUTLINE_STRENGTH = 0.45  # how much darker a surface is where it turns away from the viewer, which draws its form
OCCLUSION_RADIUS = 0.45  # of the bounding sphere: how far a surface darkens another
OCCLUSION_RAYS = 6  # a sample; a pixel has supersampling² samples
RAY_OFFSET = 2e-4  # of the bounding sphere: off the surface, so that a ray does not hit where it starts
SMOOTHING_COSINE = 0.8  # corners are shaded round where normals turn by less than 37°
GAMMA = 2.2


@dataclass(frozen=True, slots=True, eq=False)
class Shading:
    """What a camera sees of a mesh, before colour.

    face_ids : (h, w, s) int32, the face that each of a pixel's s samples sees, −1 for background.
    light : (h, w, s) float32 ≥ 0, linear light there relative to a white face lit straight on; 0 for background.
    """

    face_ids: Int32[np.ndarray, "h w s"]
    light: Float32[np.ndarray, "h w s"]


@dataclass(frozen=True, slots=True, eq=False)
class _Normals:
    """Unit normals of r seen points, (r, 3) float32, turned towards the viewer: interpolated, and the face's own."""

    smooth: np.ndarray
    flat: np.ndarray


def shaded_view(
    mesh: TriMesh,
    face_colours: UInt8[np.ndarray, "m 3"],
    size: tuple[int, int] = (480, 480),
    direction: Sequence[float] = THREE_QUARTER,
    up: UpAxis = "y",
    supersampling: int = 3,
) -> UInt8[np.ndarray, "h w 3"]:
    """Picture on a white background, (h, w, 3) uint8 sRGB; face_colours (m, 3) uint8 sRGB, the rest as for `shade`.

    Raises
    ------
    ParameterError : colours of another number than the mesh's faces; or as `shade`. DegenerateMeshError : as `shade`.
    """
    if len(face_colours) != mesh.n_faces:
        raise ParameterError(
            f"there must be one colour a face but there are {len(face_colours)} for {mesh.n_faces} faces; "
            "are both from the same mesh?"
        )
    return on_white(coloured(shade(mesh, size, direction, up, supersampling), face_colours))


def on_white(picture: UInt8[np.ndarray, "h w 4"]) -> UInt8[np.ndarray, "h w 3"]:
    """A picture with transparency laid on white paper."""
    alpha = picture[..., 3:].astype(np.float32) / 255.0
    return np.rint(picture[..., :3] * alpha + 255.0 * (1.0 - alpha)).astype(np.uint8)


def coloured(shading: Shading, face_colours: UInt8[np.ndarray, "m 3"]) -> UInt8[np.ndarray, "h w 4"]:
    """Paint what the camera sees.

    Parameters
    ----------
    face_colours : (m, 3) uint8 sRGB, one a face of the shaded mesh.

    Returns
    -------
    (h, w, 4) uint8 sRGB with straight alpha, which is the share of a pixel's samples that see the mesh.

    Raises
    ------
    ParameterError : the shading shows a face that has no colour.
    """
    if face_colours.ndim != 2 or face_colours.shape[1] != 3 or shading.face_ids.max() >= len(face_colours):
        raise ParameterError(
            f"there must be one RGB colour a face but colours are {face_colours.shape} and face "
            f"{shading.face_ids.max()} is seen; are both from the same mesh?"
        )
    linear = (face_colours.astype(np.float32) / 255.0) ** GAMMA
    is_hit = shading.face_ids >= 0
    seen = linear[shading.face_ids] * (shading.light * is_hit)[..., None]
    n_hits = is_hit.sum(axis=2, keepdims=True)
    mean = seen.sum(axis=2) / np.maximum(n_hits, 1)
    rgb = np.clip(mean, 0.0, 1.0) ** (1.0 / GAMMA)
    alpha = n_hits / is_hit.shape[2]
    return np.rint(np.concatenate([rgb, alpha], axis=2) * 255.0).astype(np.uint8)


def shade(
    mesh: TriMesh,
    size: tuple[int, int] = (480, 480),
    direction: Sequence[float] = THREE_QUARTER,
    up: UpAxis = "y",
    supersampling: int = 3,
) -> Shading:
    """Look at a mesh through a long lens: key light from the upper left, soft sky, darker where surfaces crowd.

    Parameters
    ----------
    size : (height, width) in pixels, ≥ 1; the shape fills it up to a small margin.
    direction : (right, up, front), from the shape to the camera in the shape's own frame; not along up.
    up : which axis of the mesh points up; front is the next axis in x → y → z → x ("y": front z, right x).
    supersampling : samples along each side of a pixel, 1 to 8.

    Raises
    ------
    DegenerateMeshError : all vertices that faces use coincide.
    ParameterError : a parameter out of range.
    """
    _check(size, direction, up, supersampling)
    vertices = fit_unit_sphere(mesh) @ _upright_frame(up).T
    frame = _camera_frame(np.asarray(direction, dtype=np.float64))
    local = vertices @ frame.T  # right, up, towards the camera
    scene = RayScene(local, mesh.faces)
    origins, directions = _camera_rays(local[np.unique(mesh.faces)], size, supersampling)
    hits = scene.first_hits(origins, directions)
    seen = np.flatnonzero(hits.is_hit)
    rays = directions[seen]
    normals = _facing_normals(TriMesh(local, mesh.faces), hits.face_ids[seen], hits.barycentric[seen], rays)
    points = origins[seen] + rays * hits.distances[seen, None] + normals.flat * RAY_OFFSET
    light = np.zeros(len(origins), dtype=np.float32)
    light[seen] = _light(scene, points, rays, normals, frame[:, 1], seen % supersampling**2)
    form = (*size, supersampling**2)
    return Shading(hits.face_ids.reshape(form), light.reshape(form))


def _upright_frame(up: UpAxis) -> np.ndarray:
    """Rotation (3, 3) with rows right, up, front in mesh coordinates."""
    axis = "xyz".index(up[-1])
    sign = -1.0 if up.startswith("-") else 1.0
    upward, front = np.zeros(3), np.zeros(3)
    upward[axis], front[(axis + 1) % 3] = sign, 1.0
    return np.stack([np.cross(upward, front), upward, front])


def _camera_frame(direction: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) with rows right, up, towards the camera."""
    towards = direction / np.linalg.norm(direction)
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])


def _camera_rays(used: np.ndarray, size: tuple[int, int], supersampling: int) -> tuple[np.ndarray, np.ndarray]:
    """Origins and unit directions, (h·w·s, 3) float32, in the camera's frame, framing the given points closely."""
    height, width = size
    eye_height = 1.0 / np.sin(FIELD_OF_VIEW / 2.0)
    slopes = used[:, :2] / (eye_height - used[:, 2:])
    low, high = slopes.min(axis=0), slopes.max(axis=0)
    extent = max((high[0] - low[0]) / width, (high[1] - low[1]) / height, 1e-9) * MARGIN  # slope per pixel
    offsets = (np.arange(supersampling) + 0.5) / supersampling
    across = (np.arange(width)[:, None] + offsets - width / 2.0) * extent + (low[0] + high[0]) / 2.0
    down = (np.arange(height)[:, None] + offsets - height / 2.0) * -extent + (low[1] + high[1]) / 2.0
    samples = np.empty((height, width, supersampling, supersampling, 3), dtype=np.float32)
    samples[..., 0] = across[None, :, None, :]
    samples[..., 1] = down[:, None, :, None]
    samples[..., 2] = -1.0
    directions = samples.reshape(-1, 3)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.broadcast_to(np.array([0, 0, eye_height], dtype=np.float32), directions.shape), directions


def _facing_normals(mesh: TriMesh, face_ids: np.ndarray, barycentric: np.ndarray, directions: np.ndarray) -> _Normals:
    """Normals of hits by rays of the given directions (r, 3)."""
    face_normal = face_normals(mesh)
    corner_normals = _corner_normals(mesh, face_normal)[face_ids]
    second, third = barycentric[:, :1], barycentric[:, 1:]
    smooth = corner_normals[:, 0] * (1 - second - third) + corner_normals[:, 1] * second + corner_normals[:, 2] * third
    smooth /= np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-12)
    flat = face_normal[face_ids]
    turn = np.where((flat * directions).sum(axis=1, keepdims=True) > 0, -1.0, 1.0)
    return _Normals((smooth * turn).astype(np.float32), (flat * turn).astype(np.float32))


def _corner_normals(mesh: TriMesh, face_normal: np.ndarray) -> np.ndarray:
    """Normals (m, 3, 3) at each face's corners: the vertex's where it is near the face's own, else the latter."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    weighted = np.cross(b - a, c - a)
    sums = np.stack(
        [np.bincount(mesh.faces.ravel(), np.repeat(weighted[:, k], 3), mesh.n_vertices) for k in range(3)], axis=1
    )
    vertex_normal = sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-12)
    corners = vertex_normal[mesh.faces]
    is_round = (corners * face_normal[:, None]).sum(axis=2, keepdims=True) > SMOOTHING_COSINE
    return np.where(is_round, corners, face_normal[:, None])


def _light(
    scene: RayScene, points: np.ndarray, directions: np.ndarray, normals: _Normals, up: np.ndarray, patterns: np.ndarray
) -> np.ndarray:
    """Linear light at points, (r,) float32."""
    key = np.array(KEY_LIGHT) / np.linalg.norm(KEY_LIGHT)
    direct = np.clip(normals.smooth @ key, 0.0, None)
    sky = GROUND_STRENGTH + (SKY_STRENGTH - GROUND_STRENGTH) * (normals.smooth @ up + 1.0) / 2.0
    openness = _openness(scene, points, normals.flat, patterns)
    away = (1.0 - np.clip(-(normals.smooth * directions).sum(axis=1), 0.0, 1.0)) ** 3
    return (KEY_STRENGTH * direct * (0.4 + 0.6 * openness) + sky * openness) * (1.0 - OUTLINE_STRENGTH * away)


def _openness(scene: RayScene, points: np.ndarray, normals: np.ndarray, patterns: np.ndarray) -> np.ndarray:
    """Share of a cosine-weighted hemisphere that is free of surface nearby, (r,) float32.

    The samples of a pixel cast different rays, so a pixel's mean is smooth although each casts few.
    """
    n_patterns = int(patterns.max(initial=0)) + 1
    n_directions = n_patterns * OCCLUSION_RAYS
    index = np.arange(n_directions)
    radius = np.sqrt((index + 0.5) / n_directions)
    angle = index * np.pi * (3.0 - np.sqrt(5.0))
    hemisphere = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - radius**2)], axis=1)
    tangent = np.cross(normals, np.where(np.abs(normals[:, :1]) < 0.7, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    bitangent = np.cross(normals, tangent)
    n_free = np.zeros(len(points), dtype=np.float32)
    for ray in range(OCCLUSION_RAYS):
        local = hemisphere[ray * n_patterns + patterns]
        directions = local[:, :1] * tangent + local[:, 1:2] * bitangent + local[:, 2:] * normals
        n_free += ~scene.is_occluded(points, directions, OCCLUSION_RADIUS)
    return n_free / OCCLUSION_RAYS


def _check(size: tuple[int, int], direction: Sequence[float], up: str, supersampling: int) -> None:
    if min(size) < 1:
        raise ParameterError(f"a picture must have pixels but its size is {size}; give (height, width) of at least 1")
    if not 1 <= supersampling <= 8:
        raise ParameterError(f"supersampling must be 1 to 8 but is {supersampling}; 3 is smooth")
    if up.removeprefix("-") not in ("x", "y", "z"):
        raise ParameterError(f"up must be x, y, z, -x, -y or -z but is {up!r}; choose one of them")
    vector = np.asarray(direction, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not np.hypot(vector[0], vector[2]) > 0:
        raise ParameterError(
            f"direction must be (right, up, front), finite and not along up, but is {tuple(direction)}; "
            "tilt it a little"
        )
