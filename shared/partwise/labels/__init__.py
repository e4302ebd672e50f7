"""Part schemas, and per-face label arrays as validated values and as bytes."""
