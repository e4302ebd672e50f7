"""Ray actors and the drivers that feed them: thin shells around `partwise`.

A *stage* turns one shape's arrays into new arrays (`stages/`). Actors run stages on single shapes and stage the results
(`actors.py`); a packer turns them into blocks; the driver (`runner.py`) holds ids only and publishes each block in one
catalog transaction. Training is one actor of its own (`training.py`).
"""
