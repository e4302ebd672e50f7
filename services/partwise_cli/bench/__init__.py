"""Benchmarks that anyone can run, on their own files: `partwise bench …`."""
