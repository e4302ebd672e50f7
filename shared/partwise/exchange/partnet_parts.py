"""A part table out of PartNet hierarchies: one part for each path of names, under the part its path runs through."""

from collections.abc import Iterable

from partwise.exchange.partnet import PartNetNode
from partwise.exchange.parts import PartEntry, PartTable
from partwise.labels.palette import default_colour


def partnet_part_table(hierarchies: Iterable[Iterable[PartNetNode]], version: int = 1) -> PartTable:
    """The parts of several shapes' hierarchies together, ids from 1 in order of path, whatever order shapes come in.

    Names are paths such as `chair/chair_base/leg`, as `PartNetShape.named_labels` gives them; the node's text is the
    gloss.

    Raises
    ------
    ParameterError : no part table, see `PartTable`.
    """
    texts: dict[tuple[str, ...], str] = {}
    for nodes in hierarchies:
        for node in nodes:
            texts[node.path] = min(filter(None, (texts.get(node.path, ""), node.text)), default="")
    ids = {path: part_id for part_id, path in enumerate(sorted(texts), start=1)}
    entries = (
        PartEntry(
            part_id,
            "/".join(path),
            default_colour(part_id).lower(),
            texts[path] if texts[path] != path[-1] else "",
            ids[path[:-1]] if len(path) > 1 else None,
        )
        for path, part_id in ids.items()
    )
    return PartTable(version, tuple(entries))
