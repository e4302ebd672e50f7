"""How good a labelling is against the truth."""
