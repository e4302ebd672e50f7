"""Conformance: collections, parts, people, the audit trail."""
# ruff: noqa: S101 # a test suite asserts

from partwise.errors import ConflictError, LabelError, NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.testing.expect import raises


class CollectionConformance:
    def test_collection_comes_back_as_created(self, catalog: Catalog) -> None:
        created = catalog.create_collection("chairs", ["seat"], {"upright": True, "up": "y"})
        assert catalog.get_collection("chairs") == created
        assert created.settings == {"upright": True, "up": "y"}
        assert created.created_at.utcoffset() is not None

    def test_collections_are_listed_by_name(self, catalog: Catalog) -> None:
        for name in ("mugs", "chairs"):
            catalog.create_collection(name, ["body"])
        assert [each.name for each in catalog.list_collections()] == ["chairs", "mugs"]

    def test_taken_collection_name_is_refused(self, catalog: Catalog) -> None:
        catalog.create_collection("chairs", ["seat"])
        with raises(ConflictError, "chairs"):
            catalog.create_collection("chairs", ["seat"])

    def test_padded_collection_name_is_refused(self, catalog: Catalog) -> None:
        with raises(ParameterError, "' chairs'"):
            catalog.create_collection(" chairs", ["seat"])

    def test_repeated_part_makes_no_collection(self, catalog: Catalog) -> None:
        with raises(LabelError, "seat"):
            catalog.create_collection("chairs", ["seat", "seat"])
        assert catalog.list_collections() == []

    def test_unknown_collection_names_the_known_ones(self, catalog: Catalog) -> None:
        catalog.create_collection("chairs", ["seat"])
        with raises(NotFoundError, "sofas", "chairs"):
            catalog.get_collection("sofas")

    def test_settings_given_are_changed_and_the_others_stay(self, catalog: Catalog) -> None:
        made = catalog.create_collection("chairs", ["seat"], {"up": "y", "working_faces": 10_000})
        changed = catalog.update_collection_settings(made.id, {"working_faces": 20_000, "remesh": "never"})
        assert changed.settings == {"up": "y", "working_faces": 20_000, "remesh": "never"}
        assert catalog.get_collection("chairs") == changed

    def test_changed_settings_are_on_the_audit_trail(self, catalog: Catalog) -> None:
        made = catalog.create_collection("chairs", ["seat"], {"up": "y"})
        for up in ("z", "z"):
            catalog.update_collection_settings(made.id, {"up": up})
        (entry,) = [entry for entry in catalog.audit() if entry.action == "change settings"]
        assert (entry.subject, entry.detail) == ("chairs", {"from": {"up": "y"}, "to": {"up": "z"}})

    def test_settings_of_an_unknown_collection_are_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "99"):
            catalog.update_collection_settings(99, {"up": "z"})

    def test_unknown_collection_id_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "99"):
            catalog.parts(99)

    def test_parts_are_numbered_from_one_in_order(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "back", "leg"])
        parts = catalog.parts(collection.id)
        assert (parts.version, parts.ids, parts.names) == (1, (1, 2, 3), ("seat", "back", "leg"))

    def test_added_part_makes_a_version_and_leaves_the_old_one(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat"])
        after = catalog.add_part(collection.id, "arm", "#123456", "what an elbow rests on")
        assert (after.version, after.names, after.part(2).gloss) == (2, ("seat", "arm"), "what an elbow rests on")
        assert catalog.parts(collection.id, 1).names == ("seat",)

    def test_removed_part_id_is_never_used_again(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "back"])
        assert catalog.remove_part(collection.id, 2).ids == (1,)
        assert catalog.add_part(collection.id, "back").ids == (1, 3)
        assert catalog.parts(collection.id, 1).ids == (1, 2)

    def test_renaming_keeps_version_and_id(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat"])
        after = catalog.update_part(collection.id, 1, name="cushion", colour="#000000", gloss="soft")
        part = after.part(1)
        assert (after.version, part.name, part.colour, part.gloss) == (1, "cushion", "#000000", "soft")

    def test_renaming_to_a_taken_name_is_refused(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "back"])
        with raises(ConflictError, "back"):
            catalog.update_part(collection.id, 1, name="back")

    def test_adding_a_taken_name_is_refused(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat"])
        with raises(ConflictError, "seat"):
            catalog.add_part(collection.id, "seat")
        assert catalog.get_collection("chairs").schema_version == 1

    def test_part_goes_below_another_and_back_to_the_top(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "base"])
        assert catalog.add_part(collection.id, "leg", parent_id=2).part(3).parent_id == 2
        assert catalog.update_part(collection.id, 3, name="foot").part(3).parent_id == 2
        assert catalog.update_part(collection.id, 2, parent_id=1).ancestors(3) == (2, 1)
        after = catalog.update_part(collection.id, 3, parent_id=0)
        assert (after.version, after.part(3).parent_id) == (2, None)

    def test_parents_that_go_round_or_are_unknown_are_refused(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "base"])
        before = catalog.update_part(collection.id, 2, parent_id=1)
        with raises(LabelError, "seat → base → seat"):
            catalog.update_part(collection.id, 1, parent_id=2)
        with raises(LabelError, "7"):
            catalog.update_part(collection.id, 1, parent_id=7)
        with raises(LabelError, "7"):
            catalog.add_part(collection.id, "leg", parent_id=7)
        assert catalog.parts(collection.id) == before

    def test_part_above_others_is_not_removed(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["base", "leg"])
        catalog.update_part(collection.id, 2, parent_id=1)
        with raises(ConflictError, "base", "leg"):
            catalog.remove_part(collection.id, 1)

    def test_older_version_is_without_parents_that_came_later(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["leg"])
        catalog.add_part(collection.id, "base")
        catalog.update_part(collection.id, 1, parent_id=2)
        assert catalog.parts(collection.id, 1).part(1).parent_id is None

    def test_removing_an_unknown_part_is_refused(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat"])
        with raises(LabelError, "7"):
            catalog.remove_part(collection.id, 7)

    def test_old_version_stays_readable_when_a_removed_name_is_given_away(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat", "back"])
        catalog.remove_part(collection.id, 2)
        catalog.update_part(collection.id, 1, name="back")
        assert catalog.parts(collection.id, 1).names == ("back (1)", "back (2)")

    def test_unknown_schema_version_is_refused(self, catalog: Catalog) -> None:
        collection = catalog.create_collection("chairs", ["seat"])
        for version in (0, 2):
            with raises(LabelError, str(version)):
                catalog.parts(collection.id, version)

    def test_person_comes_back_by_name(self, catalog: Catalog) -> None:
        added = catalog.add_person("Ann Ö.")
        assert catalog.get_person("Ann Ö.") == added
        assert catalog.list_people() == [added]

    def test_taken_person_name_is_refused(self, catalog: Catalog) -> None:
        catalog.add_person("ann")
        with raises(ConflictError, "ann"):
            catalog.add_person("ann")

    def test_nameless_person_is_refused(self, catalog: Catalog) -> None:
        with raises(ParameterError, "name"):
            catalog.add_person("")

    def test_unknown_person_is_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "bob"):
            catalog.get_person("bob")

    def test_audit_is_paged_in_order(self, catalog: Catalog) -> None:
        for i in range(3):
            catalog.append_audit("ann", "look", f"shape {i}", {"i": i})
        first = catalog.audit(limit=2)
        rest = catalog.audit(after=first[-1].id)
        assert [entry.detail["i"] for entry in [*first, *rest]] == [0, 1, 2]

    def test_audit_is_paged_from_its_end(self, catalog: Catalog) -> None:
        for i in range(3):
            catalog.append_audit("ann", "look", f"shape {i}", {"i": i})
        newest = catalog.latest_audit(limit=2)
        rest = catalog.latest_audit(before=newest[-1].id)
        assert [entry.detail["i"] for entry in [*newest, *rest]] == [2, 1, 0]
