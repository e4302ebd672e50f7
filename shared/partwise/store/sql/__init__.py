"""The catalog's operations in SQL, each a function of an open connection, so that they compose in one transaction."""
