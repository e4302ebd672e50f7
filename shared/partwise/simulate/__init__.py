"""Procedural collections with ground truth, clean and dirty."""
