"""The catalog (SQL: what people made) and the array store (Zarr: what a machine can make again)."""
