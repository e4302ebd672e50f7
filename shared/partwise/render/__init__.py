"""Pictures of meshes: depth views for descriptors, shaded views and contact sheets for people.

`views` defines the cameras and the `DepthRenderer` protocol; `raycast` and `gl` implement it and `probe` chooses;
`shaded` and `contact_sheet` draw coloured pictures by ray casting, with the colours of `palette`.
"""
