"""What delays give: found part by part, each no longer than the shortest delay."""
