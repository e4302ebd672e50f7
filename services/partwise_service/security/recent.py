"""`RecentlyGood`: fingerprints of secrets that were good lately. In memory, bounded."""

from collections import OrderedDict
from threading import Lock


class RecentlyGood:
    """Says which secrets need not wait for a limit that others have used up; each is still looked up every time.

    Holds hashes only, the `max_secrets` used last. Threads may share it.
    """

    def __init__(self, max_secrets: int = 10_000) -> None:
        self._fingerprints: OrderedDict[bytes, None] = OrderedDict()
        self._max_secrets = max_secrets
        self._lock = Lock()

    def holds(self, fingerprint: bytes) -> bool:
        with self._lock:
            return fingerprint in self._fingerprints

    def remember(self, fingerprint: bytes) -> None:
        with self._lock:
            self._fingerprints[fingerprint] = None
            self._fingerprints.move_to_end(fingerprint)
            while len(self._fingerprints) > self._max_secrets:
                self._fingerprints.popitem(last=False)

    def forget(self, fingerprint: bytes) -> None:
        with self._lock:
            self._fingerprints.pop(fingerprint, None)
