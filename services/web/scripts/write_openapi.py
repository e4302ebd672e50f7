"""Writes the service's OpenAPI document to the path given, for the types of the client to be made from."""

import json
import sys
from pathlib import Path

from partwise_service.app import create_app
from partwise_service.settings import ServiceSettings

document = create_app(ServiceSettings(workspace=Path("unused"))).openapi()
Path(sys.argv[1]).write_text(json.dumps(document, indent=1))
