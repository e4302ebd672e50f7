"""Folders that the operator of the machine has listed, below which a job may ingest. A caller names one, and a path."""

from collections.abc import Mapping
from pathlib import Path

from partwise.errors import ConfigError, FileFormatError, NotFoundError, ParameterError
from partwise.io.archives import plain_name

PREFIXES_VARIABLE = "PARTWISE_SERVICE_INGEST_PREFIXES"
"""The environment variable that lists them, for the service and for the workers: `scans=/data/scans,cad=/mnt/cad`."""


def parse_prefixes(text: str) -> Mapping[str, Path]:
    """Folders by name.

    Raises
    ------
    ConfigError : not `name=/folder` pairs with commas between them, or a folder that is not absolute.
    """
    found: dict[str, Path] = {}
    for pair in (each.strip() for each in text.split(",") if each.strip()):
        name, _, folder = (part.strip() for part in pair.partition("="))
        is_name = name.isascii() and name.replace("-", "").replace("_", "").isalnum()
        if not is_name or not Path(folder).is_absolute() or name in found:
            raise ConfigError(
                f"{PREFIXES_VARIABLE} must be pairs such as scans=/data/scans, each name once, each folder "
                f"absolute, but has {pair!a}"
            )
        found[name] = Path(folder)
    return found


def plain_relative(path: str) -> str:
    """A caller's path as plain steps; "" for the whole folder.

    Raises
    ------
    ParameterError : absolute, upwards, hidden, or not printable.
    """
    try:
        plain = "" if path in ("", ".", "./") else plain_name(path)
    except FileFormatError as error:
        raise ParameterError(f"a path below a prefix is wrong: {error}") from error
    if any(step.startswith(".") for step in plain.split("/")):
        raise ParameterError(f"a path below a prefix must not be hidden but is {path!a:.80}; rename the folder")
    return plain


def below_prefix(prefixes: Mapping[str, Path], prefix: str, path: str) -> Path:
    """The file or folder that a caller names.

    Raises
    ------
    NotFoundError : no such prefix, nothing there, or what is there leads out of the prefix by a link.
    ParameterError : as `plain_relative`.
    """
    plain = plain_relative(path)
    if prefix not in prefixes:
        known = ", ".join(sorted(prefixes)) or "none"
        raise NotFoundError(
            f"there is no ingest prefix {prefix!a:.80}; known: {known}; the machine's operator lists them"
        )
    folder = prefixes[prefix]
    missing = NotFoundError(f"there is nothing at {plain!a} below the prefix {prefix}; check the path")
    try:
        target = (folder / plain).resolve(strict=True)
    except (OSError, RuntimeError) as error:  # RuntimeError : links in a circle
        raise missing from error
    if not target.is_relative_to(folder.resolve()):
        raise missing
    return target
