"""The stages of a shape's way, one a file, in order: mesh, remesh, describe, evaluate, refine."""
