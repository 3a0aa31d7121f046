"""Laws turned round by a search: whether they go one way, functions for exact algebra, the search."""
