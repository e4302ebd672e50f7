"""`Repeated`: something that is done now and then, from a thread of its own, while a block lasts."""

import threading
from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self


class Repeated(ABC):
    """Calls `act` every `every_s` seconds while the block lasts, which may be entered again. name : of the thread."""

    def __init__(self, name: str, every_s: float) -> None:
        self._name = name
        self._every_s = every_s
        self._has_ended = threading.Event()
        self._thread: threading.Thread | None = None

    def __enter__(self) -> Self:
        self._has_ended.clear()
        self._thread = threading.Thread(target=self._go_on, name=self._name, daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._has_ended.set()
        if self._thread is not None:
            self._thread.join()

    @abstractmethod
    def act(self) -> None:
        """What is done. What it raises ends the thread."""

    def _go_on(self) -> None:
        while not self._has_ended.wait(self._every_s):
            self.act()
