"""The session that docs/annotate.py is, against a running service: claim, draw, confirm, export."""

import os
import subprocess
import sys
import time
import zipfile
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from partwise.store.records import JobKind, JobState, NewToken, Role
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise.workspace.export_archive import export_archive
from partwise.workspace.workspace import Workspace, open_workspace
from partwise_cli.bench.load_server import HOST, served

SCRIPT = Path(__file__).parents[3] / "docs" / "annotate.py"
MAX_LINES = 40
PATIENCE_S = 120.0


def _export_once_asked(workspace: Workspace, script: subprocess.Popen) -> None:
    """As a worker would: waits for the job that the script asks for, and does it."""
    deadline = time.monotonic() + PATIENCE_S
    while (job := workspace.catalog.claim_job("worker", [JobKind.EXPORT])) is None:
        assert script.poll() is None, script.communicate()
        assert time.monotonic() < deadline, "nothing was asked for"
        time.sleep(0.05)
    [collection] = [each for each in workspace.catalog.list_collections() if each.id == job.collection_id]
    made, _ = export_archive(workspace, collection, Segmentation(job.parameters["segmentation"]), ExportFormat.SEG)
    workspace.catalog.finish_job(job.id, "worker", JobState.DONE, result={"download": made.name})


def test_the_script_of_the_documentation_labels_a_shape_and_fetches_the_labels(mugs, tmp_path) -> None:
    out = tmp_path / "labels.zip"
    with open_workspace(mugs.path) as workspace, served(mugs.path, tmp_path / "log") as server:
        person = workspace.catalog.add_person("somebody")
        new = NewToken(person.id, Role.OPERATOR, datetime.now(UTC) + timedelta(hours=1))
        environment = {**os.environ, "PARTWISE_TOKEN": workspace.catalog.issue_token(new, "test").secret}
        command = [sys.executable, str(SCRIPT), f"http://{HOST}:{server.port}", "mugs", str(out)]
        script = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        _export_once_asked(workspace, script)
        said, complaint = script.communicate(timeout=PATIENCE_S)
        assert script.returncode == 0, complaint
        source_key, shape_id = next((key, i) for key, i in mugs.ids.items() if said.startswith(key))
        labels = workspace.catalog.labels(workspace.catalog.head_revision(shape_id).id)
    assert np.array_equal(labels, np.ones(mugs.meshes[source_key].n_faces))
    assert source_key.replace(".off", ".seg") in zipfile.ZipFile(out).namelist()


def test_the_script_is_short() -> None:
    assert len(SCRIPT.read_text(encoding="utf-8").splitlines()) <= MAX_LINES
