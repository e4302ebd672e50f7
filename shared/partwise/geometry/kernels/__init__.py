"""Compiled inner loops of the geometry package. Arrays in, arrays out; the modules above validate and explain."""
