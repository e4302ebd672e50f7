"""Compiled inner loops of the per-face descriptors. Arrays in, arrays out; the modules above validate and explain."""
