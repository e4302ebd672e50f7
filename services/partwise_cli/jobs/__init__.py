"""Jobs as rows of the catalog become work: who claims them, how they are kept alive, and what each kind does."""
