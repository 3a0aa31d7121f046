"""Every kind of port by every route: models with known runs, ways to run them, what the table says."""
