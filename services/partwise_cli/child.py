"""Runs a command for a supervisor, and ends it when the supervisor ends, however that comes about.

`python -m partwise_cli.child serve ws`
"""

import sys

from partwise_cli.parent_death import end_with_parent


def run(parent_id: int) -> None:
    """The command of `sys.argv`, as long as the process `parent_id` is there."""
    from partwise_cli.main import main

    end_with_parent(parent_id)
    main()


if __name__ == "__main__":
    run(int(sys.argv.pop(1)))
