"""Labels over faces made consistent: graph-cut energies, alpha expansion and the refinement of a model's answer."""
