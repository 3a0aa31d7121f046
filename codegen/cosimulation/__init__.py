"""Several models side by side: simulators and units of others, coupled at communication points."""
