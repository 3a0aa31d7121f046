"""Fixed steps of models whose ports hold or let go: one complementarity problem where one begins, one at its end."""
