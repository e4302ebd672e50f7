"""Conformance: drafts and their strokes."""
# ruff: noqa: S101 # a test suite asserts

from dataclasses import replace

import numpy as np
import pytest

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError, StaleDraftError
from partwise.labels.stroke_json import stroke_from_document
from partwise.store.catalog import Catalog
from partwise.store.records import (
    DraftOutcome,
    LeasePurpose,
    NewConfirmation,
    NewDraft,
    RevisionKind,
)
from partwise.testing.catalog.samples import (
    blank_draft,
    claim,
    label,
    leased_shape,
    mesh_hash,
    publish_mesh,
    ready_shapes,
    strokes,
)
from partwise.testing.expect import raises


class DraftConformance:
    def test_strokes_come_back_as_sent(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        sent = strokes(draft, 0, 3)
        assert catalog.append_strokes(draft.id, draft.person_id, 0, sent).n_strokes == 3
        found = catalog.strokes(draft.id)
        assert [stroke_from_document(each.payload) for each in found] == sent
        assert [each.sequence for each in catalog.strokes(draft.id, after=0, limit=1)] == [1]

    def test_a_draft_is_resumed_as_it_was(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        before = catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 2))
        catalog.release_lease(lease.id, lease.person_id)
        again = claim(catalog, collection, catalog.get_person("ann"))
        assert blank_draft(catalog, again) == before
        assert catalog.open_drafts(lease.person_id) == [before]
        assert catalog.drafts_of_shape(lease.shape_id) == [before]

    def test_a_draft_goes_on_under_the_next_lease(self, catalog: Catalog) -> None:
        collection, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.release_lease(lease.id, lease.person_id)
        catalog.update_collection_settings(collection.id, {"labels_per_shape": 2})
        catalog.fill_queue(collection.id)
        again = claim(catalog, collection, catalog.get_person("ann"))
        bound = catalog.draft(draft.id)
        assert again.purpose is LeasePurpose.INDEPENDENT
        assert (bound.slot, bound.round, bound.purpose) == (again.slot, again.round, again.purpose)
        assert catalog.awaited_answers(draft.id) == ([], 1)

    def test_sending_again_adds_nothing(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        sent = strokes(draft, 0, 4)
        catalog.append_strokes(draft.id, draft.person_id, 0, sent[:3])
        assert catalog.append_strokes(draft.id, draft.person_id, 0, sent[:3]).n_strokes == 3
        assert catalog.append_strokes(draft.id, draft.person_id, 2, sent[2:]).n_strokes == 4
        assert [each.id for each in catalog.strokes(draft.id)] == [str(stroke.id) for stroke in sent]

    def test_no_strokes_change_nothing(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        assert catalog.append_strokes(draft.id, draft.person_id, 0, []) == draft

    @pytest.mark.parametrize("first", [0, 2])
    def test_a_wrong_sequence_says_what_is_on_record(self, catalog: Catalog, first: int) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 1))
        with pytest.raises(StaleDraftError, match="sequence 1") as refused:
            catalog.append_strokes(draft.id, draft.person_id, first, strokes(draft, first, 1))
        assert (refused.value.state["n_strokes"], refused.value.state["draft_id"]) == (1, draft.id)
        assert len(catalog.strokes(draft.id)) == 1

    def test_an_id_stands_for_one_stroke(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        first, second = strokes(draft, 0, 2)
        catalog.append_strokes(draft.id, draft.person_id, 0, [first])
        with raises(StaleDraftError, "other content"):
            catalog.append_strokes(draft.id, draft.person_id, 1, [replace(second, id=first.id)])
        with raises(ParameterError, "id of its own"):
            catalog.append_strokes(draft.id, draft.person_id, 1, [second, replace(second, sequence=2)])

    def test_strokes_are_numbered_their_authors_and_on_the_drafts_base(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        (stroke,) = strokes(draft, 0, 1)
        with raises(ParameterError, "numbered"):
            catalog.append_strokes(draft.id, draft.person_id, 0, [replace(stroke, sequence=1)])
        with raises(ParameterError, "their author's"):
            catalog.append_strokes(draft.id, draft.person_id, 0, [replace(stroke, author_id=99)])
        with raises(StaleDraftError, "revision None"):
            catalog.append_strokes(draft.id, draft.person_id, 0, [replace(stroke, base_revision=7)])

    def test_drafts_are_their_authors_own(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft, bob = blank_draft(catalog, lease), catalog.add_person("bob")
        with raises(ConflictError, "another person's"):
            catalog.append_strokes(draft.id, bob.id, 0, [])
        with raises(ConflictError, "another person's"):
            catalog.discard_draft(draft.id, bob.id)
        with raises(ConflictError, "another person's"):
            catalog.open_draft(lease.id, bob.id, NewDraft(draft.mesh_hash, None, draft.base_sha256, 1))
        with raises(ConflictError, "another person's"):
            catalog.confirm_draft(NewConfirmation(draft.id, bob.id, 0, np.ones(6, int), 1))

    def test_a_draft_is_on_the_shapes_mesh_and_labels(self, catalog: Catalog) -> None:
        collection, (shape_id, other) = ready_shapes(catalog, 2)
        foreign = label(catalog, other)
        own = label(catalog, shape_id)
        lease = catalog.claim_shape(shape_id, catalog.add_person("bob").id, 60)
        new = NewDraft(mesh_hash(shape_id), own.id, own.sha256, 1)
        for wrong in (
            replace(new, mesh_hash=mesh_hash(other)),
            replace(new, base_revision=foreign.id),
            replace(new, base_revision=99),
            replace(new, base_sha256="0" * 64),
        ):
            with raises(LabelError, "a draft must"):
                catalog.open_draft(lease.id, lease.person_id, wrong)
        assert catalog.open_draft(lease.id, lease.person_id, new).base_revision == own.id
        assert collection.id == catalog.shape(shape_id).collection_id

    def test_a_draft_does_not_start_from_reference_labels(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        secret = label(catalog, lease.shape_id, RevisionKind.REFERENCE)
        with raises(LabelError, "is not that"):
            catalog.open_draft(
                lease.id, lease.person_id, NewDraft(mesh_hash(lease.shape_id), secret.id, secret.sha256, 1)
            )

    def test_a_discarded_draft_keeps_its_strokes_and_takes_no_more(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 1))
        assert catalog.discard_draft(draft.id, draft.person_id).outcome is DraftOutcome.DISCARDED
        assert len(catalog.strokes(draft.id)) == 1
        with raises(ConflictError, "discarded"):
            catalog.append_strokes(draft.id, draft.person_id, 1, strokes(draft, 1, 1))
        assert blank_draft(catalog, lease).id != draft.id

    def test_a_closed_draft_passes_over_strokes_that_it_has(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        sent = strokes(draft, 0, 3)
        catalog.append_strokes(draft.id, draft.person_id, 0, sent[:2])
        closed = catalog.discard_draft(draft.id, draft.person_id)
        assert catalog.append_strokes(draft.id, draft.person_id, 0, sent[:2]) == closed
        with pytest.raises(StaleDraftError, match="discarded") as refused:
            catalog.append_strokes(draft.id, draft.person_id, 1, sent[1:])
        assert (refused.value.state["outcome"], refused.value.state["n_strokes"]) == (DraftOutcome.DISCARDED, 2)
        assert len(catalog.strokes(draft.id)) == 2

    def test_strokes_are_taken_after_the_lease_has_ended(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        catalog.release_lease(lease.id, lease.person_id)
        assert catalog.append_strokes(draft.id, draft.person_id, 0, strokes(draft, 0, 1)).n_strokes == 1

    def test_a_draft_keeps_its_mesh_from_being_swept(self, catalog: Catalog) -> None:
        _, lease = leased_shape(catalog)
        draft = blank_draft(catalog, lease)
        publish_mesh(catalog, lease.shape_id, version=2)
        old = catalog.mesh(lease.shape_id, draft.mesh_hash)
        assert old.block_name not in [block.name for block in catalog.unused_blocks()]

    def test_unknown_drafts_and_answers_are_refused(self, catalog: Catalog) -> None:
        for use in (lambda: catalog.draft(99), lambda: catalog.answer_labels(99), lambda: catalog.awaited_answers(99)):
            with raises(NotFoundError, "99"):
                use()
        assert catalog.strokes(99) == []
