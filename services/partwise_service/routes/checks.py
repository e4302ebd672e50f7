"""/collections/{collection_id}/blind-checks, /disagreements, /shapes/{shape_id}/answers: how right people are."""

from itertools import groupby
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from partwise.errors import NotFoundError
from partwise.store.catalog import Catalog
from partwise.store.records import Answer, Consensus, Effort, Role
from partwise.store.reviews import Review, ReviewReason
from partwise_service.answering import AnswerRoute, waits_for_arrays
from partwise_service.array_responses import (
    PNG_RESPONSES,
    SAFETENSORS_RESPONSES,
    entity_tag,
    not_modified,
    safetensors_response,
)
from partwise_service.dependencies import CatalogDep, Reviewer, ScopedCollection, ScopedShape, WorkspaceDep
from partwise_service.schemas.base import MAX_ROW_ID, Page, RowId
from partwise_service.schemas.checks import (
    BlindCheckOut,
    CheckedPeople,
    CheckedPerson,
    Choice,
    DisagreementOut,
    IndependentLabels,
)
from partwise_service.schemas.shapes import EffortOut, RevisionOut
from partwise_service.shown_labels import ShownLabels
from partwise_service.thumbnails import thumbnail_response

MAX_PAGE = 500
MAX_DISAGREEMENTS = 100
router = APIRouter(route_class=AnswerRoute, tags=["checks"])
After = Annotated[int, Query(ge=0, le=MAX_ROW_ID, description="`next` of the page before.")]


@router.get("/collections/{collection_id}/blind-checks")
def list_blind_checks(
    caller: Reviewer,
    collection: ScopedCollection,
    catalog: CatalogDep,
    person: Annotated[int | None, Query(ge=1, le=MAX_ROW_ID)] = None,
    after: After = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_PAGE)] = 100,
) -> Page[BlindCheckOut]:
    """Measurements of people's labels against references, oldest first. The caller's own are left out.

    Which shapes they were of is for operators: whoever knows them cannot be measured with them any more.
    """
    found = catalog.blind_checks(
        collection.id, after=after, limit=limit, person_id=person, but_person_id=caller.person_id
    )
    names = _names(catalog)
    is_operator = caller.role.includes(Role.OPERATOR)
    return Page(
        items=[BlindCheckOut.of(each, names[each.person_id], tells_shape=is_operator) for each in found],
        next=str(found[-1].id) if len(found) == limit else None,
    )


@router.get("/collections/{collection_id}/blind-checks/people")
def list_checked_people(caller: Reviewer, collection: ScopedCollection, catalog: CatalogDep) -> CheckedPeople:
    """How right each person is, over time. The caller is left out."""
    names = _names(catalog)
    days = [each for each in catalog.blind_check_days(collection.id) if each.person_id != caller.person_id]
    people = groupby(days, key=lambda each: each.person_id)
    return CheckedPeople(items=[CheckedPerson.of(names[person_id], list(own)) for person_id, own in people])


@router.get("/collections/{collection_id}/disagreements")
def list_disagreements(
    _caller: Reviewer,
    collection: ScopedCollection,
    catalog: CatalogDep,
    after: After = 0,
    limit: Annotated[int, Query(ge=1, le=MAX_DISAGREEMENTS)] = 50,
) -> Page[DisagreementOut]:
    """Shapes whose independent labels differ too much, and wait for a reviewer, oldest first."""
    found = catalog.open_reviews(collection.id, after=after, limit=limit, reasons=(ReviewReason.DISAGREEMENT,))
    shapes, names = catalog.shapes_by_id([review.shape_id for review in found]), _names(catalog)
    items = []
    for review in found:
        consensus = _settled(catalog, review)
        if consensus is not None:  # labels moved to another mesh leave what was compared behind
            efforts = catalog.answer_efforts(consensus.answer_ids)
            answers = [_told(each, consensus, names, efforts.get(each.id)) for each in _answers(catalog, consensus)]
            items.append(DisagreementOut.of(review, shapes[review.shape_id].source_key, consensus, answers))
    return Page(items=items, next=str(found[-1].id) if len(found) == limit else None)


@router.get("/shapes/{shape_id}/answers/{answer_id}/labels", responses=SAFETENSORS_RESPONSES, response_class=Response)
def read_answer(
    request: Request, _caller: Reviewer, shape: ScopedShape, catalog: CatalogDep, answer_id: RowId
) -> Response:
    """`labels` (m,) uint16 of one person, where a round of independent labels is complete."""
    answer = _compared_answer(catalog, shape.id, answer_id)
    tag = entity_tag("answer", answer.id, answer.sha256)
    held = not_modified(request, tag)
    if held is not None:
        return held
    labels = catalog.answer_labels(answer.id)
    return safetensors_response(request, {"labels": labels}, tag, metadata={"mesh_hash": answer.mesh_hash})


@router.get("/shapes/{shape_id}/answers/{answer_id}/thumbnail", responses=PNG_RESPONSES, response_class=Response)
@waits_for_arrays
def show_answer(
    request: Request, _caller: Reviewer, shape: ScopedShape, workspace: WorkspaceDep, answer_id: RowId
) -> Response:
    """PNG of the shape in the colours of one person's labels, where a round of independent labels is complete."""
    catalog = workspace.catalog
    answer = _compared_answer(catalog, shape.id, answer_id)
    labels = ShownLabels(answer.mesh_hash, f"answer {answer.id}", lambda: catalog.answer_labels(answer.id))
    return thumbnail_response(request, workspace, shape, labels)


@router.post("/shapes/{shape_id}/reviews/{review_id}/choose")
def choose_labels(
    caller: Reviewer, shape: ScopedShape, catalog: CatalogDep, review_id: RowId, choice: Choice
) -> RevisionOut:
    """Make one person's labels the shape's, in their name, which resolves a disagreement."""
    if all(each.id != review_id for each in catalog.reviews(shape.id)):
        raise NotFoundError(f"shape {shape.id} has no disagreement {review_id}; see /disagreements")
    return RevisionOut.of(catalog.choose_answer(review_id, choice.answer_id, caller.person_id))


def _compared_answer(catalog: Catalog, shape_id: int, answer_id: int) -> Answer:
    """An answer of a round that is complete: before, nobody sees it, and what was measured blindly nobody ever does."""
    compared = {each for consensus in catalog.consensus_of(shape_id) for each in consensus.answer_ids}
    for answer in catalog.answers(shape_id):
        if answer.id == answer_id and answer.id in compared:
            return answer
    raise NotFoundError(f"shape {shape_id} has no labels {answer_id} to compare; see /disagreements")


def _settled(catalog: Catalog, review: Review) -> Consensus | None:
    rounds = [each for each in catalog.consensus_of(review.shape_id) if each.revision_id == review.revision_id]
    return rounds[-1] if rounds else None


def _answers(catalog: Catalog, consensus: Consensus) -> list[Answer]:
    return [each for each in catalog.answers(consensus.shape_id) if each.id in consensus.answer_ids]


def _told(answer: Answer, consensus: Consensus, names: dict[int, str], effort: Effort | None) -> IndependentLabels:
    return IndependentLabels(
        id=answer.id,
        person_id=answer.person_id,
        person_name=names[answer.person_id],
        mesh_hash=answer.mesh_hash,
        is_medoid=answer.id == consensus.medoid_id,
        created_at=answer.created_at,
        effort=EffortOut.of(effort),
    )


def _names(catalog: Catalog) -> dict[int, str]:
    return {person.id: person.name for person in catalog.list_people()}
