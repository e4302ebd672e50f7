"""How right people are: against references, and against each other."""

from datetime import date, datetime

from partwise.store.records import BlindCheck, BlindCheckDay, Consensus
from partwise.store.reviews import Review
from partwise_service.schemas.base import Answer, AnyId, Request
from partwise_service.schemas.shapes import EffortOut


class ClosenessOut(Answer):
    """area_agreement : share of the area with the same label. part_iou : mean over parts. boundary_distance : mean, as
    a fraction of the bounding box's diagonal.
    """

    area_agreement: float
    part_iou: float
    boundary_distance: float


class BlindCheckOut(ClosenessOut):
    """A person's labels, measured against a reference without their knowing. shape_id : told to operators only."""

    id: int
    person_id: int
    person_name: str
    shape_id: int | None
    checked_at: datetime

    @classmethod
    def of(cls, check: BlindCheck, person_name: str, *, tells_shape: bool) -> "BlindCheckOut":
        """The check as it is told."""
        measured = ClosenessOut.model_validate(check.closeness)
        return cls(
            **measured.model_dump(),
            id=check.id,
            person_id=check.person_id,
            person_name=person_name,
            shape_id=check.shape_id if tells_shape else None,
            checked_at=check.checked_at,
        )


class BlindCheckDayOut(ClosenessOut):
    """Means over a day's checks."""

    day: date
    n_checks: int


class CheckedPerson(ClosenessOut):
    """Means over all of a person's checks, and by day (UTC), oldest first."""

    person_id: int
    person_name: str
    n_checks: int
    days: list[BlindCheckDayOut]

    @classmethod
    def of(cls, person_name: str, days: list[BlindCheckDay]) -> "CheckedPerson":
        """A person's figures from those of their days, at least one."""
        n_checks = sum(day.n_checks for day in days)

        def mean(name: str) -> float:
            return float(sum(getattr(day.mean, name) * day.n_checks for day in days) / n_checks)

        return cls(
            **{name: mean(name) for name in ClosenessOut.model_fields},
            person_id=days[0].person_id,
            person_name=person_name,
            n_checks=n_checks,
            days=[
                BlindCheckDayOut(
                    **ClosenessOut.model_validate(day.mean).model_dump(), day=day.day, n_checks=day.n_checks
                )
                for day in days
            ],
        )


class CheckedPeople(Answer):
    items: list[CheckedPerson]


class IndependentLabels(Answer):
    """One person's labels of a round; they are at /shapes/{shape_id}/answers/{id}/labels. is_medoid : the closest to
    the others, which are the shape's as long as nobody decides otherwise. effort : null where nobody noted it.
    """

    id: int
    person_id: int
    person_name: str
    mesh_hash: str
    is_medoid: bool
    created_at: datetime
    effort: EffortOut | None


class DisagreementOut(ClosenessOut):
    """People's labels of a shape that are too far from each other; the measures are means over all pairs.

    review_id : accepting it keeps the medoid's labels, rejecting has the shape labelled again, choosing takes others.
    """

    review_id: int
    shape_id: int
    source_key: str
    revision_id: int
    created_at: datetime
    answers: list[IndependentLabels]

    @classmethod
    def of(
        cls, review: Review, source_key: str, consensus: Consensus, answers: list[IndependentLabels]
    ) -> "DisagreementOut":
        """The disagreement as it is told."""
        return cls(
            **ClosenessOut.model_validate(consensus.closeness).model_dump(),
            review_id=review.id,
            shape_id=review.shape_id,
            source_key=source_key,
            revision_id=review.revision_id,
            created_at=review.created_at,
            answers=answers,
        )


class Choice(Request):
    """Whose labels are right."""

    answer_id: AnyId
