"""The stages of a shape's way, one a file, in order: mesh, describe, evaluate, refine."""
