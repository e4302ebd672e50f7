"""Compiled inner loops of the simulated annotator."""
