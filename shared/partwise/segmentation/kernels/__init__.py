"""Compiled inner loops of segmentation."""
