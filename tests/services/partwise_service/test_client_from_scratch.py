"""The sessions of docs/client-from-scratch.md against a running service: claim, draw, confirm, export."""

import os
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from partwise.store.records import JobKind, JobState, NewToken, Role
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export_archive import export_archive
from partwise.workspace.workspace import Workspace, open_workspace
from partwise_cli.bench.load_server import HOST, served

DOCS = Path(__file__).parents[3] / "docs"
SCRIPT = DOCS / "annotate.py"
MAX_LINES = 40
PATIENCE_S, POLL_S = 120.0, 0.05
TOOLS = ("bash", "curl", "jq")


def _export_once_asked(workspace: Workspace, session: subprocess.Popen) -> None:
    """As a worker would: waits for the job that the session asks for, and does it."""
    for _ in range(int(PATIENCE_S / POLL_S)):
        job = workspace.catalog.claim_job("worker", [JobKind.EXPORT])
        if job is not None:
            break
        assert session.poll() is None, session.communicate()
        threading.Event().wait(POLL_S)
    else:
        pytest.fail("nothing was asked for")
    [collection] = [each for each in workspace.catalog.list_collections() if each.id == job.collection_id]
    made, _ = export_archive(workspace, collection, Segmentation(job.parameters["segmentation"]), ExportFormat.SEG)
    workspace.catalog.finish_job(job.id, "worker", JobState.DONE, result={"download": made.name})


def _said(workspace: Workspace, command: Sequence[str], folder: Path, environment: Mapping[str, str]) -> str:
    """What a session says, run in a folder as an operator, with an export made in between."""
    person = workspace.catalog.add_person("somebody")
    new = NewToken(person.id, Role.OPERATOR, datetime.now(UTC) + timedelta(hours=1))
    secret = workspace.catalog.issue_token(new, "test").secret
    session = subprocess.Popen(
        command,
        env={**os.environ, **environment, "PARTWISE_TOKEN": secret},
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    _export_once_asked(workspace, session)
    said, complaint = session.communicate(timeout=PATIENCE_S)
    assert session.returncode == 0, complaint
    return said


def _by_hand() -> str:
    """The commands that the page shows for use without a program of one's own."""
    page = (DOCS / "client-from-scratch.md").read_text(encoding="utf-8")
    [block] = [each for each in re.findall(r"^```\n(.*?)^```$", page, re.DOTALL | re.MULTILINE) if "API=" in each]
    return str(block)


def _all_of_one_part(workspace: Workspace, mugs) -> str:
    """The key of the one shape that was labelled, with part 1 all over."""
    [(key, head)] = [(k, r) for k, i in mugs.ids.items() if (r := workspace.catalog.head_revision(i)) is not None]
    assert np.array_equal(workspace.catalog.labels(head.id), np.ones(mugs.meshes[key].n_faces))
    return str(key)


def test_the_script_of_the_documentation_labels_a_shape_and_fetches_the_labels(mugs, tmp_path) -> None:
    with open_workspace(mugs.path) as workspace, served(mugs.path, tmp_path / "log") as server:
        command = [sys.executable, str(SCRIPT), f"http://{HOST}:{server.port}", "mugs", "labels.zip"]
        said = _said(workspace, command, tmp_path, {})
        source_key = _all_of_one_part(workspace, mugs)
    assert said.startswith(source_key)
    assert source_key.replace(".off", ".seg") in zipfile.ZipFile(tmp_path / "labels.zip").namelist()


@pytest.mark.skipif(not all(map(shutil.which, TOOLS)), reason=f"needs {', '.join(TOOLS)}")
def test_the_commands_of_the_documentation_do_the_same(mugs, tmp_path) -> None:
    downloads = tmp_path / "downloads"
    downloads.mkdir()
    with open_workspace(mugs.path) as workspace, served(mugs.path, tmp_path / "log") as server:
        command = ["bash", "-euo", "pipefail", "-c", _by_hand()]
        _said(workspace, command, downloads, {"API": f"http://{HOST}:{server.port}/api/v1"})
        source_key = _all_of_one_part(workspace, mugs)
    [archive] = downloads.iterdir()
    assert source_key.replace(".off", ".seg") in zipfile.ZipFile(archive).namelist()


def test_the_script_is_short() -> None:
    assert len(SCRIPT.read_text(encoding="utf-8").splitlines()) <= MAX_LINES
