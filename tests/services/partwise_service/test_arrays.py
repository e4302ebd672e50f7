"""Meshes and labels as safetensors, thumbnails as PNG: what they hold, tags, caching, compression."""

import gzip

import numpy as np
import pytest
from safetensors.numpy import load

from partwise.render.thumbnail import PICTURE_SIZE
from partwise.store.block_kinds import EVALUATION
from partwise.store.records import NewBlock, NewRevision, NewStageRun, RevisionKind
from partwise.testing.spheres import ball
from partwise.testing.workspaces import publish_evaluation, publish_meshes, publish_picture, publish_refinement
from partwise_service.array_responses import IMMUTABLE, REVALIDATE, SAFETENSORS


@pytest.fixture
def mesh_path(mugs) -> str:
    return f"/meshes/{mugs.meshes['b.off'].content_hash()}?shape_id={mugs.ids['b.off']}"


@pytest.fixture
def pictured(workspace, mugs) -> int:
    """a.off with its picture."""
    publish_picture(workspace, mugs.ids["a.off"], mugs.meshes["a.off"])
    return mugs.ids["a.off"]


def _confirm(workspace, mugs, key: str, part_id: int = 1) -> int:
    catalog, shape_id = workspace.catalog, mugs.ids[key]
    known = {person.name: person for person in catalog.list_people()}
    author = known.get("eve") or catalog.add_person("eve")
    labels = np.full(mugs.meshes[key].n_faces, part_id)
    mesh_hash = mugs.meshes[key].content_hash()
    return catalog.add_revision(NewRevision(shape_id, mesh_hash, RevisionKind.HUMAN, author.id, 1, labels)).id


def test_a_mesh_keeps_its_faces_in_order(annotator, mesh_path, mugs) -> None:
    answer = annotator.get(mesh_path)
    arrays = load(answer.content)
    np.testing.assert_array_equal(arrays["faces"], mugs.meshes["b.off"].faces)
    np.testing.assert_array_equal(arrays["vertices"], mugs.meshes["b.off"].vertices.astype(np.float32))
    assert (answer.headers["content-type"], arrays["faces"].dtype) == (SAFETENSORS, np.uint32)


def test_a_mesh_is_kept_for_ever(annotator, mesh_path) -> None:
    answer = annotator.get(mesh_path)
    assert answer.headers["cache-control"] == IMMUTABLE
    again = annotator.get(mesh_path, headers={"If-None-Match": answer.headers["etag"]})
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", answer.headers["etag"])


@pytest.mark.parametrize("held", ['W/"0"', '"x", "y"', "*x"])
def test_another_tag_gets_the_mesh(annotator, mesh_path, held) -> None:
    assert annotator.get(mesh_path, headers={"If-None-Match": held}).status_code == 200


def test_one_of_several_tags_is_enough(annotator, mesh_path) -> None:
    tag = annotator.get(mesh_path).headers["etag"]
    assert annotator.get(mesh_path, headers={"If-None-Match": f'"x", {tag}'}).status_code == 304


def test_what_a_stage_did_again_is_not_taken_for_what_it_did_before(annotator, workspace, mugs) -> None:
    catalog, shape_id = workspace.catalog, mugs.ids["a.off"]
    model = catalog.latest_model(mugs.collection_id)
    paths = [f"/shapes/{shape_id}/labels?segmentation=refined", f"/shapes/{shape_id}/uncertainty"]
    tags = [annotator.get(path).headers["etag"] for path in paths]
    n_faces = mugs.meshes["a.off"].n_faces
    publish_refinement(workspace, model, {shape_id: np.ones(n_faces, dtype=np.uint16)})
    publish_evaluation(workspace, model, (1, 2), {shape_id: np.full((n_faces, 2), 0.5)})
    for path, tag in zip(paths, tags, strict=True):
        assert annotator.get(path, headers={"If-None-Match": tag}).status_code == 200, path


class TestCompression:
    @pytest.fixture
    def path(self, annotator, workspace, mugs) -> str:
        """Of a mesh that is worth it."""
        mesh = ball(3)
        publish_meshes(workspace, {mugs.ids["a.off"]: mesh}, "mesh-2")
        return f"/meshes/{mesh.content_hash()}?shape_id={mugs.ids['a.off']}"

    def _raw(self, annotator, client, path: str, accepted: str):
        with client.stream(
            "GET", f"/api/v1{path}", headers={**annotator.headers, "Accept-Encoding": accepted}
        ) as answer:
            return answer.headers, b"".join(answer.iter_raw())

    def test_who_takes_gzip_gets_it(self, annotator, client, path) -> None:
        plain_headers, plain = self._raw(annotator, client, path, "identity")
        headers, packed = self._raw(annotator, client, path, "br, gzip;q=0.8")
        assert (headers["content-encoding"], headers["vary"]) == ("gzip", "Accept-Encoding")
        assert gzip.decompress(packed) == plain
        assert len(packed) < len(plain)
        assert "content-encoding" not in plain_headers

    @pytest.mark.parametrize("accepted", ["", "br", "gzip;q=0", "identity, *;q=0"])
    def test_who_does_not_gets_it_plain(self, annotator, client, path, accepted) -> None:
        assert "content-encoding" not in self._raw(annotator, client, path, accepted)[0]


@pytest.mark.parametrize(("segmentation", "part_id"), [("predicted", 1), ("refined", 2)])
def test_labels_by_segmentation(annotator, mugs, segmentation, part_id) -> None:
    answer = annotator.get(f"/shapes/{mugs.ids['b.off']}/labels", params={"segmentation": segmentation})
    labels = load(answer.content)["labels"]
    assert labels.dtype == np.uint16
    np.testing.assert_array_equal(labels, np.full(mugs.meshes["b.off"].n_faces, part_id))
    assert mugs.meshes["b.off"].content_hash().encode() in answer.content[:400]  # the metadata


def test_uncertainty_is_the_entropy_of_each_face_as_a_share_of_the_largest(annotator, workspace, mugs) -> None:
    mesh = mugs.meshes["a.off"]
    probabilities = np.tile([[1.0, 0.0], [0.5, 0.5], [0.75, 0.25], [0.0, 1.0]], (mesh.n_faces // 4, 1))
    block = workspace.arrays.write_block(
        EVALUATION, [{"probabilities": probabilities.astype(np.float16), "part_ids": np.array([1, 2], np.uint16)}]
    )
    summary = {"mesh_hash": mesh.content_hash(), "model_version": 1}
    workspace.catalog.publish_block(
        NewBlock(block.name, EVALUATION.name, 1, block.n_bytes, block.checksum),
        [NewStageRun(mugs.ids["a.off"], "evaluate", "k2", 0, summary=summary)],
    )
    answer = annotator.get(f"/shapes/{mugs.ids['a.off']}/uncertainty")
    uncertainty = load(answer.content)["uncertainty"]
    assert uncertainty.dtype == np.float32
    np.testing.assert_allclose(uncertainty, np.tile([0, 1, 0.8112781, 0], mesh.n_faces // 4), atol=1e-6)
    held = {"If-None-Match": answer.headers["etag"]}
    assert annotator.get(f"/shapes/{mugs.ids['a.off']}/uncertainty", headers=held).status_code == 304


def test_no_model_knows_no_uncertainty(admin, mugs) -> None:
    assert admin.get(f"/shapes/{mugs.other_shape_id}/uncertainty").status_code == 404


def test_confirmed_labels_change_their_tag(annotator, workspace, mugs) -> None:
    path = f"/shapes/{mugs.ids['a.off']}/labels"
    assert annotator.get(path).status_code == 404
    _confirm(workspace, mugs, "a.off", 1)
    first = annotator.get(path)
    assert first.headers["cache-control"] == REVALIDATE
    held = {"If-None-Match": first.headers["etag"]}
    assert annotator.get(path, headers=held).status_code == 304
    _confirm(workspace, mugs, "a.off", 2)
    second = annotator.get(path, headers=held)
    assert (second.status_code, load(second.content)["labels"].tolist()) == (200, [2, 2, 2, 2])


def test_an_older_revision_can_be_read(annotator, workspace, mugs) -> None:
    first = _confirm(workspace, mugs, "a.off", 1)
    _confirm(workspace, mugs, "a.off", 2)
    answer = annotator.get(f"/shapes/{mugs.ids['a.off']}/labels", params={"revision": first})
    assert load(answer.content)["labels"].tolist() == [1, 1, 1, 1]


def test_a_revision_of_another_shape_is_not_found(annotator, workspace, mugs) -> None:
    revision_id = _confirm(workspace, mugs, "b.off")
    answer = annotator.get(f"/shapes/{mugs.ids['a.off']}/labels", params={"revision": revision_id})
    assert answer.status_code == 404


def test_labels_of_an_earlier_mesh_are_not_shown_on_the_present_one(annotator, workspace, mugs) -> None:
    publish_meshes(workspace, {mugs.ids["a.off"]: ball(1)}, "mesh-2")
    path = f"/shapes/{mugs.ids['a.off']}/labels"
    assert annotator.get(path, params={"segmentation": "predicted"}).status_code == 404


def test_a_shape_without_a_picture_has_no_thumbnail(annotator, mugs) -> None:
    assert annotator.get(f"/shapes/{mugs.ids['a.off']}/thumbnail").status_code == 404


def test_a_thumbnail_is_a_png(annotator, pictured) -> None:
    answer = annotator.get(f"/shapes/{pictured}/thumbnail", params={"segmentation": "predicted"})
    assert (answer.status_code, answer.headers["content-type"]) == (200, "image/png")
    width, height = (int.from_bytes(answer.content[at : at + 4], "big") for at in (16, 20))
    assert (width, height) == (PICTURE_SIZE // 2, PICTURE_SIZE // 2)


def test_a_thumbnails_tag_follows_labels_and_colours(annotator, reviewer, workspace, mugs, pictured) -> None:
    path = f"/shapes/{pictured}/thumbnail"
    confirmed = {"params": {"segmentation": "confirmed"}}
    tags = [annotator.get(path).headers["etag"]]
    assert annotator.get(path, **confirmed).headers["etag"] == tags[0]  # there are none: grey, too
    _confirm(workspace, mugs, "a.off")
    tags.append(annotator.get(path, **confirmed).headers["etag"])
    reviewer.patch(f"/collections/{mugs.collection_id}/parts/1", json={"colour": "#010203"})
    tags.append(annotator.get(path, **confirmed).headers["etag"])
    assert len(set(tags)) == 3
    assert annotator.get(path, headers={"If-None-Match": tags[-1]}, **confirmed).status_code == 304
