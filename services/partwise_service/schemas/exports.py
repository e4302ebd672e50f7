"""Exports: which labels, in which format, on which mesh."""

from typing import Annotated, Literal

from pydantic import Field

from partwise.store.records import JobKind, MeshRole
from partwise.workspace.choices import ExportFormat, Segmentation
from partwise_service.schemas.base import Request


class ExportParameters(Request):
    """on : the mesh that people label, or the file's own faces, to which labels are mapped back."""

    segmentation: Annotated[Segmentation, Field(strict=False)] = Segmentation.CONFIRMED
    format: Annotated[ExportFormat, Field(strict=False)] = ExportFormat.SEG
    on: Annotated[MeshRole, Field(strict=False)] = MeshRole.WORKING


class NewExport(Request):
    """An archive of label files, for /jobs/{job_id}/download."""

    kind: Literal[JobKind.EXPORT]
    parameters: ExportParameters = ExportParameters()
