"""Runs a command for a supervisor, and ends it when the supervisor ends, however that comes about.

`python -m partwise_cli.child serve ws`
"""

import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1  # of Linux's prctl
ORPHANED = 1


def end_with_parent(parent_id: int) -> None:
    """From now on SIGTERM comes when the process `parent_id`, which started this one, has gone."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent_id:  # gone before it was asked for
        sys.exit(ORPHANED)


def run(parent_id: int) -> None:
    """The command of `sys.argv`, as long as the process `parent_id` is there."""
    from partwise_cli.main import main

    end_with_parent(parent_id)
    main()


if __name__ == "__main__":
    run(int(sys.argv.pop(1)))
