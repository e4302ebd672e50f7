"""What happens to a process when the one that started it ends."""

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
