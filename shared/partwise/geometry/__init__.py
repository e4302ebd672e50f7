"""Discrete geometry on triangle meshes, one operator a file."""
