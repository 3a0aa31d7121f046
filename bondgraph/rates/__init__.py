"""Every state's rate as an expression: rates resolved, laws put in."""
