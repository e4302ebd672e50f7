"""Partwise's domain: meshes, descriptors, segmentation, learning and the two stores, in plain Python.

Nothing here knows of Ray or FastAPI. Packages import only those below them; `make check` enforces the order.
"""

__version__ = "0.1.0"
