"""What every implementation of a store must pass, and Hypothesis strategies for meshes. Needs the `dev` extra."""
