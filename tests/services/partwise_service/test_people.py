"""/people, /tokens, /audit."""

import pytest


def test_people_are_listed_by_name(reviewer, annotator) -> None:
    assert [person["name"] for person in reviewer.get("/people").json()["items"]] == ["ann", "rita"]


def test_an_operator_adds_a_person(operator) -> None:
    assert operator.post("/people", json={"name": "Bob B."}).json()["name"] == "Bob B."
    assert operator.post("/people", json={"name": "Bob B."}).status_code == 409


@pytest.mark.parametrize("name", ["", " bob", "bob\r\nX-Evil: 1", "bob\u202e", "x" * 201])
def test_names_that_cannot_be_told_apart_are_refused(operator, name) -> None:
    assert operator.post("/people", json={"name": name}).status_code == 422


def test_a_new_token_lets_its_person_in(admin, nobody, mugs) -> None:
    person_id = admin.post("/people", json={"name": "bob"}).json()["id"]
    body = {"person_id": person_id, "role": "annotator", "scope": [mugs.collection_id], "days": 1, "note": "summer"}
    issued = admin.post("/tokens", json=body)
    assert issued.status_code == 201
    me = nobody.get("/me", headers={"Authorization": f"Bearer {issued.json()['secret']}"}).json()
    assert (me["name"], me["role"], me["scope"]) == ("bob", "annotator", [mugs.collection_id])


def test_tokens_are_listed_without_their_secrets(admin, annotator) -> None:
    listed = admin.get("/tokens")
    assert {token["person_name"] for token in listed.json()["items"]} == {"ada", "ann"}
    assert annotator.secret not in listed.text
    assert "sha256" not in listed.text


def test_pages_of_tokens(admin, annotator, reviewer) -> None:
    first = admin.get("/tokens", params={"limit": 2}).json()
    second = admin.get("/tokens", params={"limit": 2, "after": first["next"]}).json()
    assert [len(first["items"]), len(second["items"]), second["next"]] == [2, 1, None]


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"person_id": 99}, 404), ({"scope": [99]}, 404), ({"scope": []}, 422), ({"role": "king"}, 422),
        ({"days": 0}, 422), ({"days": 5_000}, 422), ({"person_id": "1"}, 422), ({"admin": True}, 422),
    ],
)  # fmt: skip
def test_tokens_that_cannot_be(admin, change, status) -> None:
    body = {"person_id": 1, "role": "annotator", **change}
    assert admin.post("/tokens", json=body).status_code == status


def test_one_may_end_ones_own_token(annotator) -> None:
    me = annotator.get("/me")
    assert me.status_code == 200
    assert annotator.delete("/tokens/1").json()["revoked_at"] is not None
    assert annotator.get("/me").status_code == 401


def test_nobody_ends_the_token_of_another(reviewer, annotator) -> None:
    assert {annotator.delete(f"/tokens/{i}").status_code for i in (1, 99)} == {403}
    assert reviewer.get("/me").status_code == 200


def test_the_audit_trail_says_who_did_what(admin) -> None:
    admin.post("/people", json={"name": "bob"})
    newest = admin.get("/audit").json()["items"][0]
    assert (newest["actor"], newest["action"], newest["detail"]) == ("ada", "add person", {"name": "bob"})


def test_the_audit_trail_is_read_page_by_page_from_its_end(admin) -> None:
    for name in ("bob", "cleo", "dan"):
        admin.post("/people", json={"name": name})
    first = admin.get("/audit", params={"limit": 2}).json()
    rest = admin.get("/audit", params={"limit": 1, "before": first["next"]}).json()
    assert [each["detail"]["name"] for each in first["items"] + rest["items"]] == ["dan", "cleo", "bob"]


def test_the_audit_trail_can_only_be_read(admin) -> None:
    assert {admin.request(method, "/audit").status_code for method in ("POST", "PUT", "PATCH", "DELETE")} == {405}
