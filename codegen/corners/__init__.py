"""Where laws have corners: each on one side of them all, and the search for the next."""
