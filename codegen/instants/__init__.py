"""All that happens at one instant: modes, impacts, and what events set states to."""
