"""Impulses of stops that throw back what meets them; fixed steps with stops, and with resets."""
