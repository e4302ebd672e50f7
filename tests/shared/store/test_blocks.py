"""Declarations of blocks, their names, and the size of what is stored and read."""

import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
import zarr

from partwise.errors import ParameterError
from partwise.store import keys
from partwise.store.block_kinds import FEATURES, MESH, N_LIGHT_FIELD
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise.store.objects import LocalObjects
from partwise.store.open_arrays import open_array_store
from partwise.store.zarr_store import ZarrArrayStore


def test_an_unknown_dtype_is_refused() -> None:
    with pytest.raises(ParameterError, match="float31"):
        Quantity("a", Domain.FACE, "float31")


def test_an_empty_width_is_refused() -> None:
    with pytest.raises(ParameterError, match="positive"):
        Quantity("a", Domain.FACE, "uint8", (0,))


@pytest.mark.parametrize(
    "quantities", [(), (Quantity("a", Domain.FACE, "uint8"), Quantity("a", Domain.SHAPE, "uint8"))]
)
def test_a_kind_needs_quantities_of_different_names(quantities: tuple[Quantity, ...]) -> None:
    with pytest.raises(ParameterError, match="different names"):
        BlockKind("odd", quantities)


def test_block_names_carry_their_time() -> None:
    now = datetime(2026, 3, 4, 5, 6, 7, 891_000, tzinfo=UTC)
    assert keys.block_time(keys.new_block_name("mesh", now)) == now


def test_block_names_sort_by_time() -> None:
    start = datetime(2026, 3, 4, tzinfo=UTC)
    names = [keys.new_block_name("mesh", start + timedelta(milliseconds=i)) for i in range(20)]
    assert names == sorted(names)


@pytest.mark.parametrize("kind", ["", "../mesh", "a/b/../c", "mesh mesh"])
def test_a_kind_that_makes_no_safe_name_is_refused(kind: str) -> None:
    with pytest.raises(ParameterError, match="key"):
        keys.new_block_name(kind, datetime(2026, 3, 4, tzinfo=UTC))


@pytest.mark.parametrize(
    "name",
    [
        "blocks/mesh/x",
        "blocks/01a202e1-28d1-7be2-8cff-321cdf346d67",
        "other/mesh/01a202e1-28d1-7be2-8cff-321cdf346d67",
        "blocks/mesh/01A202E1-28D1-7BE2-8CFF-321CDF346D67",
        "blocks/mesh/01a202e1-28d1-4be2-8cff-321cdf346d67",
    ],
)
def test_what_is_no_block_name_is_refused(name: str) -> None:
    with pytest.raises(ParameterError, match="must look like"):
        keys.checked_block_name(name)


def _features(rng: np.random.Generator, n_faces: int) -> dict[str, np.ndarray]:
    return {
        "shape_context": rng.integers(0, 255, (n_faces, 256), dtype=np.uint8),
        "shape_context_scale": np.array(0.5, np.float32),
        "spin_image": rng.integers(0, 255, (n_faces, 256), dtype=np.uint8),
        "spin_image_scale": np.array(0.25, np.float32),
        "shape_diameter": rng.random(n_faces, dtype=np.float32),
        "light_field": rng.integers(0, 255, N_LIGHT_FIELD, dtype=np.uint8),
    }


def test_a_feature_block_is_a_handful_of_objects(store: ZarrArrayStore) -> None:
    rng = np.random.default_rng(2)
    address = store.write_block(FEATURES, [_features(rng, n) for n in (100, 5_000, 300)])
    assert len(store._objects.keys(address.name)) <= 2 * (len(FEATURES.quantities) + 1) + 1


def test_a_block_is_a_plain_zarr_group(store: ZarrArrayStore, tmp_path: Path) -> None:
    faces = np.arange(30, dtype=np.uint32).reshape(10, 3)
    address = store.write_block(MESH, [{"vertices": np.ones((4, 3), np.float32), "faces": faces}] * 2)
    group = zarr.open_group(tmp_path / "arrays" / address.name, mode="r")
    np.testing.assert_array_equal(group["face_ptr"][:], [0, 10, 20])
    np.testing.assert_array_equal(group["faces"][10:20], faces)


def test_one_shape_is_a_ranged_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a shard of 40 chunks, reading one shape fetches its own chunk or two and the index."""
    store = open_array_store(str(tmp_path / "arrays"))
    rng = np.random.default_rng(4)
    kind = BlockKind("codes", (Quantity("codes", Domain.FACE, "uint8", (16,)),))
    address = store.write_block(kind, [{"codes": rng.integers(0, 256, (4_096, 16), dtype=np.uint8)} for _ in range(40)])
    fetched = []
    get = type(store._zarr._store).get

    async def counting(self: object, key: str, *rest: object, **named: object) -> object:
        found = await get(self, key, *rest, **named)  # type: ignore[arg-type]
        fetched.append(len(found) if found is not None else 0)
        return found

    monkeypatch.setattr(type(store._zarr._store), "get", counting)
    store.read(address.name, 17, "codes")
    assert sum(fetched) < address.n_bytes / 10


def test_unfinished_files_are_never_listed(tmp_path: Path) -> None:
    objects = LocalObjects(tmp_path)
    objects.put("a/b", b"x")
    (tmp_path / ".partial" / "left-behind").write_bytes(b"half")
    assert objects.keys("") == ["a/b"]
    assert objects.folders("") == ["a"]


def test_old_unfinished_files_are_swept(tmp_path: Path) -> None:
    objects = LocalObjects(tmp_path)
    assert objects.sweep_unfinished(datetime.now(UTC)) == 0
    objects.put("a/b", b"x")
    for name, age_s in (("old", 10_000), ("young", 0)):
        file = tmp_path / ".partial" / name
        file.write_bytes(b"half")
        os.utime(file, (file.stat().st_mtime - age_s,) * 2)
    assert objects.sweep_unfinished(datetime.now(UTC) - timedelta(hours=1)) == 1
    assert [file.name for file in (tmp_path / ".partial").iterdir()] == ["young"]
