"""From labelled faces to part probabilities: the only package that imports torch."""
