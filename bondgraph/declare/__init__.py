"""What a user declares: kinds of node, laws, fields, switches, and graphs that are checked and frozen."""
