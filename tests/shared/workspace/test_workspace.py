"""Making, opening and migrating workspaces: whole or not at all."""

import shutil
from pathlib import Path

import pytest
from sqlalchemy import create_engine, text

from partwise.config import CONFIG_FILE
from partwise.errors import ConfigError, ConflictError, LabelError, NotFoundError, ParameterError, StoreError
from partwise.store import migrate
from partwise.testing.expect import raises
from partwise.workspace.workspace import (
    INITIAL_CONFIG,
    Workspace,
    init_collection,
    init_workspace,
    migrate_workspace,
    open_workspace,
)

LATER_MIGRATION = """
revision = "9999"
down_revision = "{newest}"
def upgrade():
    pass
"""
CLOSED_PORT = "postgresql://nobody@127.0.0.1:9/none"


def test_a_new_workspace_opens(tmp_path: Path) -> None:
    init_workspace(tmp_path / "deep" / "ws")
    with open_workspace(tmp_path / "deep" / "ws") as workspace:
        assert list(workspace.catalog.list_collections()) == []


def test_an_empty_folder_becomes_a_workspace(tmp_path: Path) -> None:
    init_workspace(tmp_path)
    assert (tmp_path / CONFIG_FILE).read_text() == INITIAL_CONFIG


def test_init_leaves_a_workspace_as_it_is(path: Path) -> None:
    (path / CONFIG_FILE).write_text("[workers]\nn_actors = 3\n")
    with open_workspace(path) as workspace:
        workspace.catalog.create_collection("mugs", ["body"])
    init_workspace(path)
    with open_workspace(path) as workspace:
        assert [collection.name for collection in workspace.catalog.list_collections()] == ["mugs"]
        assert workspace.config.workers.n_actors == 3


def test_init_keeps_a_configuration_written_beforehand(tmp_path: Path) -> None:
    (tmp_path / CONFIG_FILE).write_text('[stores]\ndatabase_url = "sqlite:///other.sqlite"\n')
    init_workspace(tmp_path)
    assert (tmp_path / "other.sqlite").is_file()


def test_init_refuses_a_file(tmp_path: Path) -> None:
    (tmp_path / "ws").write_text("")
    with raises(ConfigError, "ws", "is a file", "choose another"):
        init_workspace(tmp_path / "ws")


def test_init_refuses_a_folder_that_holds_other_things(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("")
    with raises(ConfigError, str(tmp_path), "holds other files", "choose another"):
        init_workspace(tmp_path)


@pytest.mark.parametrize("variable", ["PARTWISE_DATABASE_URL", "PARTWISE_STORE_URL"])
@pytest.mark.parametrize("is_there", [True, False])
def test_init_leaves_nothing_when_a_store_cannot_be_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str, is_there: bool
) -> None:
    path = tmp_path / "ws"
    if is_there:
        path.mkdir()
    (tmp_path / "a file").write_text("")
    url = CLOSED_PORT if variable == "PARTWISE_DATABASE_URL" else str(tmp_path / "a file" / "arrays")
    monkeypatch.setenv(variable, url)
    with pytest.raises(StoreError):
        init_workspace(path)
    assert path.exists() == is_there
    assert not is_there or list(path.iterdir()) == []


def test_a_collection_comes_with_its_workspace(tmp_path: Path) -> None:
    made = init_collection(tmp_path / "ws", "mugs", ["body", "handle"], {"up": "z"})
    with open_workspace(tmp_path / "ws") as workspace:
        assert workspace.catalog.get_collection("mugs") == made
        assert workspace.catalog.parts(made.id).names == ("body", "handle")


@pytest.mark.parametrize(
    ("name", "parts", "kind"),
    [
        ("mugs", [], LabelError),
        ("mugs", ["body", "body"], LabelError),
        ("mugs", ["body,handle"], LabelError),
        (" mugs", ["body"], ParameterError),
    ],
)
def test_a_refused_collection_leaves_no_workspace(
    tmp_path: Path, name: str, parts: list[str], kind: type[Exception]
) -> None:
    with pytest.raises(kind):
        init_collection(tmp_path / "ws", name, parts, {})
    assert not (tmp_path / "ws").exists()


def test_a_collection_whose_name_is_taken_leaves_the_workspace_alone(path: Path) -> None:
    init_collection(path, "mugs", ["body"], {})
    with raises(ConflictError, "'mugs'", "taken"):
        init_collection(path, "mugs", ["handle"], {})
    with open_workspace(path) as workspace:
        assert workspace.catalog.parts(workspace.catalog.get_collection("mugs").id).names == ("body",)


def test_opening_what_is_no_workspace_says_how_to_make_one(tmp_path: Path) -> None:
    with raises(ConfigError, CONFIG_FILE, "partwise init"), open_workspace(tmp_path):
        pass


def test_opening_without_its_catalog_says_so(path: Path) -> None:
    (path / "catalog.sqlite").unlink()
    with raises(NotFoundError, "catalog.sqlite", "partwise init"), open_workspace(path):
        pass


def test_locations_are_inside_the_workspace_wherever_it_is_opened_from(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(path.parent)
    with open_workspace(Path(path.name)) as workspace:
        assert workspace.array_url == str(path.resolve() / "arrays")


def test_an_absolute_location_stays_absolute(path: Path, tmp_path: Path) -> None:
    (path / CONFIG_FILE).write_text(f'[stores]\narray_url = "{tmp_path}/elsewhere"\n')
    with open_workspace(path) as workspace:
        assert workspace.array_url == f"{tmp_path.resolve()}/elsewhere"


def test_a_store_url_is_passed_on(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PARTWISE_STORE_URL", "memory://test-workspace")
    with open_workspace(path) as workspace:
        assert workspace.array_url == "memory://test-workspace"


@pytest.mark.parametrize(
    ("key", "variable", "url"),
    [
        ("database_url", "PARTWISE_DATABASE_URL", "mysql://host/name"),
        ("array_url", "PARTWISE_STORE_URL", "nowhere://bucket"),
    ],
)
def test_a_wrong_url_says_where_it_was_written(
    path: Path, monkeypatch: pytest.MonkeyPatch, key: str, variable: str, url: str
) -> None:
    monkeypatch.setenv(variable, url)
    with raises(ConfigError, variable, key), open_workspace(path):
        pass
    monkeypatch.delenv(variable)
    (path / CONFIG_FILE).write_text(f'[stores]\n{key} = "{url}"\n')
    with raises(ConfigError, str(path / CONFIG_FILE), key), open_workspace(path):
        pass


def test_migrating_what_is_up_to_date_changes_nothing(path: Path) -> None:
    init_collection(path, "mugs", ["body"], {})
    migrate_workspace(path)
    with open_workspace(path) as workspace:
        assert [collection.name for collection in workspace.catalog.list_collections()] == ["mugs"]


def test_migrating_brings_an_older_catalog_up_to_date(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = path.parent / "migrations"
    shutil.copytree(migrate._MIGRATIONS, folder)
    newest = max(file.name[1:5] for file in (folder / "versions").glob("m*.py"))
    (folder / "versions" / "m9999_hats.py").write_text(LATER_MIGRATION.format(newest=newest))
    monkeypatch.setattr(migrate, "_MIGRATIONS", folder)
    with raises(StoreError, "partwise migrate"), open_workspace(path):
        pass
    migrate_workspace(path)
    with open_workspace(path) as workspace:
        assert list(workspace.catalog.list_collections()) == []


def test_migrating_refuses_a_newer_catalog(path: Path) -> None:
    engine = create_engine(f"sqlite:///{path / 'catalog.sqlite'}")
    with engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = 'from the future'"))
    engine.dispose()
    with raises(StoreError, "newer", "use a newer partwise"):
        migrate_workspace(path)


def test_migrating_does_not_put_an_empty_catalog_in_place_of_a_lost_one(path: Path) -> None:
    (path / "catalog.sqlite").unlink()
    with raises(NotFoundError, "catalog.sqlite"):
        migrate_workspace(path)
    assert not (path / "catalog.sqlite").exists()


def test_a_workspace_closes_its_catalog(path: Path) -> None:
    with open_workspace(path) as workspace:
        workspace.catalog.list_collections()
    assert not (path / "catalog.sqlite-wal").exists()


def test_migrate_needs_a_workspace(tmp_path: Path, workspace: Workspace) -> None:
    with raises(ConfigError, CONFIG_FILE):
        migrate_workspace(tmp_path)
