"""The conformance suite of `ArrayStore`."""
# ruff: noqa: S101 # a test suite asserts

from datetime import timedelta

import numpy as np

from partwise.errors import NotFoundError, ParameterError, StoreError
from partwise.store.array_store import ArrayStore
from partwise.store.block_kinds import EVALUATION, MESH, REFINEMENT
from partwise.store.blocks import BlockKind, Domain, Quantity
from partwise.testing.expect import raises

_MIXED = BlockKind(
    "mixed",
    (
        Quantity("height", Domain.VERTEX, "float32"),
        Quantity("codes", Domain.FACE, "uint8", (4,)),
        Quantity("scale", Domain.SHAPE, "float32"),
        Quantity("views", Domain.SHAPE, "uint8", (5_000,)),
    ),
)


def _mixed(rng: np.random.Generator, n_vertices: int, n_faces: int) -> dict[str, np.ndarray]:
    return {
        "height": rng.random(n_vertices, dtype=np.float32),
        "codes": rng.integers(0, 256, (n_faces, 4), dtype=np.uint8),
        "scale": np.array(rng.random(), np.float32),
        "views": rng.integers(0, 256, 5_000, dtype=np.uint8),
    }


def _labels(*n_faces: int) -> list[dict[str, np.ndarray]]:
    return [{"labels": np.arange(n, dtype=np.uint16)} for n in n_faces]


class ArrayStoreConformance:
    """What every `ArrayStore` must pass. A subclass provides a pytest fixture `store`: an empty store."""

    def test_every_row_comes_back_as_written(self, store: ArrayStore) -> None:
        rng = np.random.default_rng(7)
        shapes = [_mixed(rng, *sizes) for sizes in ((3, 1), (5_000, 9_000), (1, 4_096), (4_097, 2))]
        address = store.write_block(_MIXED, shapes)
        assert address.n_shapes == 4
        for row, shape in enumerate(shapes):
            found = store.read_many(address.name, row, tuple(shape))
            for quantity, values in shape.items():
                assert found[quantity].dtype == values.dtype
                np.testing.assert_array_equal(found[quantity], values)

    def test_a_shape_may_span_shards(self, store: ArrayStore) -> None:
        shapes = [{"labels": (np.arange(n) % 65_521).astype(np.uint16)} for n in (300_000, 500_000, 7, 524_288)]
        address = store.write_block(REFINEMENT, shapes)
        for row, shape in enumerate(shapes):
            np.testing.assert_array_equal(store.read(address.name, row, "labels"), shape["labels"])

    def test_zeros_are_written_too(self, store: ArrayStore) -> None:
        address = store.write_block(REFINEMENT, [{"labels": np.zeros(10_000, np.uint16)}])
        np.testing.assert_array_equal(store.read(address.name, 0, "labels"), np.zeros(10_000))

    def test_an_open_width_is_settled_when_written(self, store: ArrayStore) -> None:
        rng = np.random.default_rng(3)
        part_ids = np.array([1, 2, 5], np.uint16)
        shapes = [{"probabilities": rng.random((n, 3)).astype(np.float16), "part_ids": part_ids} for n in (4, 9)]
        address = store.write_block(EVALUATION, shapes)
        np.testing.assert_array_equal(store.read(address.name, 1, "probabilities"), shapes[1]["probabilities"])
        np.testing.assert_array_equal(store.read(address.name, 0, "part_ids"), part_ids)

    def test_names_are_fresh_and_under_their_kind(self, store: ArrayStore) -> None:
        names = [store.write_block(REFINEMENT, _labels(3)).name for _ in range(2)]
        assert len(set(names)) == 2
        assert all(name.startswith("blocks/refinement/") for name in names)
        assert list(store.block_names()) == sorted(names)

    def test_equal_blocks_have_equal_checksums(self, store: ArrayStore) -> None:
        first, second, other = (store.write_block(REFINEMENT, _labels(n)) for n in (3, 3, 4))
        assert first.checksum == second.checksum != other.checksum
        store.verify(first)

    def test_a_block_that_differs_from_its_address_is_found(self, store: ArrayStore) -> None:
        first, other = (store.write_block(REFINEMENT, _labels(n)) for n in (3, 4))
        swapped = type(first)(first.name, first.n_shapes, first.n_bytes, other.checksum)
        with raises(StoreError, first.name):
            store.verify(swapped)

    def test_no_shapes_are_refused(self, store: ArrayStore) -> None:
        with raises(ParameterError, "at least one"):
            store.write_block(REFINEMENT, [])

    def test_a_missing_or_unknown_quantity_is_refused(self, store: ArrayStore) -> None:
        with raises(ParameterError, "labels"):
            store.write_block(REFINEMENT, [{}])
        with raises(ParameterError, "colour"):
            store.write_block(REFINEMENT, [_labels(3)[0] | {"colour": np.zeros(3)}])

    def test_a_wrong_dtype_is_refused(self, store: ArrayStore) -> None:
        with raises(ParameterError, "uint16", "int64"):
            store.write_block(REFINEMENT, [{"labels": np.zeros(3, np.int64)}])

    def test_a_wrong_width_is_refused(self, store: ArrayStore) -> None:
        with raises(ParameterError, "vertices", "(4, 2)"):
            store.write_block(MESH, [{"vertices": np.zeros((4, 2), np.float32), "faces": np.zeros((2, 3), np.uint32)}])

    def test_an_array_without_rows_is_refused(self, store: ArrayStore) -> None:
        with raises(ParameterError, "labels"):
            store.write_block(REFINEMENT, _labels(3, 0))

    def test_uneven_face_counts_are_refused(self, store: ArrayStore) -> None:
        kind = BlockKind("uneven", (Quantity("a", Domain.FACE, "uint8"), Quantity("b", Domain.FACE, "uint8")))
        with raises(ParameterError, "shape 1", "one mesh"):
            store.write_block(kind, [{"a": np.zeros(n, np.uint8), "b": np.zeros(2, np.uint8)} for n in (2, 3)])
        assert store.block_names() == []

    def test_an_unknown_row_or_quantity_is_refused(self, store: ArrayStore) -> None:
        name = store.write_block(REFINEMENT, _labels(3)).name
        for row in (1, -1):
            with raises(NotFoundError, "row"):
                store.read(name, row, "labels")
        with raises(NotFoundError, "colour", "labels"):
            store.read(name, 0, "colour")

    def test_a_deleted_block_is_gone_even_when_it_was_open(self, store: ArrayStore) -> None:
        name = store.write_block(REFINEMENT, _labels(3)).name
        store.read(name, 0, "labels")
        store.delete_block(name)
        store.delete_block(name)
        assert store.block_names() == []
        with raises(StoreError, name):
            store.read(name, 0, "labels")

    def test_only_a_blocks_name_deletes_a_block(self, store: ArrayStore) -> None:
        store.write_block(REFINEMENT, _labels(3))
        for name in ("blocks", "blocks/refinement", "kept/meshes", "../blocks", "blocks/refinement/.."):
            with raises(ParameterError, "must"):
                store.delete_block(name)
        assert len(store.block_names()) == 1

    def test_orphans_are_invisible_and_old_enough(self, store: ArrayStore) -> None:
        visible, orphan = (store.write_block(REFINEMENT, _labels(3)).name for _ in range(2))
        in_the_past = timedelta(days=-1)  # a limit a day ahead, so that what was just written counts as old
        assert list(store.orphans({visible}, in_the_past)) == [orphan]
        assert store.orphans({visible}, timedelta(days=1)) == []

    def test_sweeping_leaves_finished_objects(self, store: ArrayStore) -> None:
        store.put_bytes("models/1", b"x")
        address = store.write_block(REFINEMENT, _labels(3))
        assert store.sweep_unfinished(timedelta(days=-1)) == 0
        assert store.exists("models/1")
        store.verify(address)

    def test_bytes_come_back_and_are_replaced(self, store: ArrayStore) -> None:
        for data in (b"first", b"", b"\x00second"):
            store.put_bytes("sources/ab/cd.off", data)
            assert store.get_bytes("sources/ab/cd.off") == data

    def test_existence_follows_put_and_delete(self, store: ArrayStore) -> None:
        assert not store.exists("models/1.json")
        store.put_bytes("models/1.json", b"{}")
        assert store.exists("models/1.json")
        store.delete("models/1.json")
        store.delete("models/1.json")
        assert not store.exists("models/1.json")
        with raises(NotFoundError, "models/1.json"):
            store.get_bytes("models/1.json")

    def test_a_folder_is_no_object(self, store: ArrayStore) -> None:
        store.put_bytes("models/1/weights", b"x")
        assert not store.exists("models/1")
        with raises(NotFoundError, "models/1"):
            store.get_bytes("models/1")

    def test_keys_are_listed_below_a_folder(self, store: ArrayStore) -> None:
        for key in ("models/2/w", "models/1", "modelsx/3"):
            store.put_bytes(key, b"x")
        assert list(store.list("models")) == ["models/1", "models/2/w"]
        assert list(store.list("nothing")) == []

    def test_unsafe_keys_are_refused(self, store: ArrayStore) -> None:
        bad = ("", "/etc/passwd", "a/../b", "..", "a//b", "a/", "a/.hidden", "a b", "a\\b", "a\n", "ä", "a" * 513)
        for key in bad:
            with raises(ParameterError, "key"):
                store.put_bytes(key, b"x")

    def test_plain_objects_stay_out_of_blocks_and_staging(self, store: ArrayStore) -> None:
        for key in ("blocks/mesh/x", "staging/x"):
            with raises(ParameterError, "under"):
                store.put_bytes(key, b"x")

    def test_staged_arrays_come_back(self, store: ArrayStore) -> None:
        arrays = _mixed(np.random.default_rng(1), 4, 5)
        store.stage("run/1", arrays)
        found = store.read_staged("run/1")
        assert set(found) == set(arrays)
        for name, values in arrays.items():
            assert (found[name].dtype, found[name].shape) == (values.dtype, values.shape)
            np.testing.assert_array_equal(found[name], values)

    def test_staged_views_come_back_in_order(self, store: ArrayStore) -> None:
        values = np.arange(12, dtype=np.float32).reshape(3, 4)
        store.stage("views", {"transposed": values.T, "stepped": values[:, ::2], "big_endian": values.astype(">f4")})
        found = store.read_staged("views")
        np.testing.assert_array_equal(found["transposed"], values.T)
        np.testing.assert_array_equal(found["stepped"], values[:, ::2])
        np.testing.assert_array_equal(found["big_endian"], values)

    def test_staging_is_listed_and_emptied(self, store: ArrayStore) -> None:
        for key in ("a/1", "a/2", "b/1"):
            store.stage(key, {"x": np.zeros(1)})
        assert list(store.staged_keys("a")) == ["a/1", "a/2"]
        store.delete_staged("a/1")
        store.delete_staged("a/1")
        assert list(store.staged_keys()) == ["a/2", "b/1"]
        with raises(NotFoundError, "a/1"):
            store.read_staged("a/1")

    def test_many_staged_are_deleted_at_once_whether_they_are_there_or_not(self, store: ArrayStore) -> None:
        for key in ("a/1", "a/2", "b/1"):
            store.stage(key, {"x": np.zeros(1)})
        store.put_bytes("models/1", b"x")
        store.delete_staged_many(["a/1", "a/gone", "b/1", "c/gone"])
        assert list(store.staged_keys()) == ["a/2"]
        store.delete_staged_many(["a/1", "a/gone"])
        store.delete_staged_many([])
        assert list(store.staged_keys()) == ["a/2"]
        assert store.exists("models/1")
        with raises(ParameterError, "key"):
            store.delete_staged_many(["../models/1"])
