"""Who may do what: credentials, sessions, origins, limits, and the headers that browsers obey."""
