"""Which shapes to label next: `embedding` (PCA of descriptors), `clustering` (first shapes), `acquisition` (scores)."""
