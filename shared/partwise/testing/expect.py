"""Expecting an error without depending on a test runner."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def raises(kind: type[Exception], *words: str) -> Iterator[None]:
    """Fail unless the block raises `kind` with one line that holds all of `words`.

    Raises
    ------
    AssertionError : nothing was raised, the words are missing, or the message has more than one line.
    """
    try:
        yield
    except kind as error:
        message = str(error)
        missing = [word for word in words if word not in message]
        if missing or "\n" in message:
            raise AssertionError(f"expected one line with {words} but got {message!r}") from error
        return
    raise AssertionError(f"expected {kind.__name__} but nothing was raised")
