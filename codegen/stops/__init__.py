"""Stops: the impulses that throw back what meets them, and fixed steps with them."""
