"""What a shape is like, as arrays: descriptors of its faces (context, spin image, diameter) and of the whole shape.

Each is one module with a frozen parameter class and a function from a `TriMesh` to an array.
"""
