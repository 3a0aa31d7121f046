"""What runs tell: how they differ, and how they oscillate."""
