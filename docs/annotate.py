"""Label one shape over HTTP, then fetch the labels: python annotate.py http://127.0.0.1:8000 COLLECTION labels.zip

Written from /api/v1/openapi.json alone. The token is read from PARTWISE_TOKEN; exports take the role operator.
"""

import os
import sys
import time
import uuid
from datetime import UTC, datetime
from pathlib import Path

import httpx

url, name, out = sys.argv[1:]
headers = {"Authorization": f"Bearer {os.environ['PARTWISE_TOKEN']}"}
with httpx.Client(base_url=f"{url}/api/v1/", headers=headers, timeout=60) as api:

    def call(method, path, body=None, **more):
        return api.request(method, path, json=body, headers=more).raise_for_status().json()

    me = call("GET", "me")
    collection = next(each for each in call("GET", "collections")["items"] if each["name"] == name)["id"]
    part = call("GET", f"collections/{collection}/parts")["parts"][0]
    [lease] = call("POST", "queue/claim", {"collection_id": collection})["items"]
    draft = call("POST", f"leases/{lease['id']}/draft", {})
    n_faces = call("GET", f"shapes/{lease['shape_id']}")["mesh"]["n_faces"]
    stroke = {"v": 1, "kind": "assign", "runs": [[0, n_faces]], "label": part["id"], "id": str(uuid.uuid4())}
    stroke |= {"sequence": draft["n_strokes"], "base_revision": draft["base_revision"], "author_id": me["person_id"]}
    stroke["at"] = datetime.now(UTC).isoformat().replace("+00:00", "Z")
    draft = call(
        "POST", f"drafts/{draft['id']}/strokes", {"expected_sequence": draft["n_strokes"], "strokes": [stroke]}
    )
    call("POST", f"drafts/{draft['id']}/confirm", {}, **{"If-Match": f'"{draft["n_strokes"]}"'})
    job = call("POST", f"collections/{collection}/jobs", {"kind": "export", "parameters": {"format": "seg"}})
    while job["state"] in ("pending", "running"):  # for `partwise work`, or the worker of `partwise up`
        time.sleep(0.5)
        job = call("GET", f"jobs/{job['id']}")
    Path(out).write_bytes(api.get(f"jobs/{job['id']}/download").raise_for_status().content)
    sys.stdout.write(f"{lease['source_key']} is {part['name']} all over; labels are in {out}\n")
