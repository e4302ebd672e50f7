"""Mesh files: OFF, OBJ, PLY, STL and GLB in and out, face order untouched.

Start at `partwise.io.read.read_mesh` and `partwise.io.write.write_mesh`. The parsers are our own because labels are
arrays over faces: general loaders group faces by corner count (PLY), split them by material (OBJ), walk scenes in an
order of their own or read undecoded geometry as zeros (GLB).
"""
