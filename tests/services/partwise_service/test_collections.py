"""/collections: what exists for whom, settings, making one."""

import pytest

from partwise.store.records import Role


def test_collections_are_listed_by_name(operator) -> None:
    assert [each["name"] for each in operator.get("/collections").json()["items"]] == ["mugs", "vases"]


def test_collections_outside_the_scope_are_not_listed(annotator) -> None:
    assert [each["name"] for each in annotator.get("/collections").json()["items"]] == ["mugs"]


def test_a_collection_tells_what_was_set(annotator, mugs) -> None:
    shown = annotator.get(f"/collections/{mugs.collection_id}").json()
    assert (shown["name"], shown["settings"], shown["schema_version"]) == ("mugs", {"up": "y"}, 1)


def test_a_collection_outside_the_scope_looks_like_none(annotator, mugs) -> None:
    foreign = annotator.get(f"/collections/{mugs.other_id}")
    unknown = annotator.get("/collections/99")
    assert (foreign.status_code, unknown.status_code) == (404, 404)
    assert foreign.json() == {**unknown.json(), "detail": unknown.json()["detail"].replace("99", str(mugs.other_id))}


def test_an_operator_changes_settings_and_the_rest_stays(operator, mugs) -> None:
    path = f"/collections/{mugs.collection_id}/settings"
    assert operator.patch(path, json={"working_faces": 5_000}).json()["settings"] == {"up": "y", "working_faces": 5_000}


def test_an_operator_changes_how_work_is_handed_out(operator, mugs) -> None:
    path = f"/collections/{mugs.collection_id}/settings"
    change = {
        "labels_per_shape": 3,
        "agreement": 0.8,
        "honeypot_share": 0.1,
        "review": True,
        "train_after": 0,
        "up": "z",
    }
    assert operator.patch(path, json=change).json()["settings"] == change


@pytest.mark.parametrize("change", [{"labels_per_shape": 10}, {"agreement": 2}, {"review": 1}, {"train_after": -1}])
def test_a_setting_out_of_range_is_refused(operator, mugs, change) -> None:
    assert operator.patch(f"/collections/{mugs.collection_id}/settings", json=change).status_code == 422


def test_a_change_of_nothing_changes_nothing(operator, mugs) -> None:
    path = f"/collections/{mugs.collection_id}/settings"
    assert operator.patch(path, json={}).json()["settings"] == {"up": "y"}


def test_an_unknown_setting_is_refused(operator, mugs) -> None:
    answer = operator.patch(f"/collections/{mugs.collection_id}/settings", json={"colour": "red"})
    assert answer.status_code == 422


def test_settings_take_an_operator(reviewer, mugs) -> None:
    assert reviewer.patch(f"/collections/{mugs.collection_id}/settings", json={"up": "z"}).status_code == 403


def test_an_operator_makes_a_collection(operator) -> None:
    answer = operator.post("/collections", json={"name": "lamps", "parts": ["base", "shade"]})
    assert (answer.status_code, answer.json()["name"]) == (201, "lamps")


def test_a_name_is_taken_once(operator) -> None:
    assert operator.post("/collections", json={"name": "mugs", "parts": ["base"]}).status_code == 409


def test_an_operator_of_some_collections_makes_none(issue, mugs) -> None:
    some = issue("olga", Role.OPERATOR, (mugs.collection_id,))
    assert some.post("/collections", json={"name": "lamps", "parts": ["base"]}).status_code == 403
