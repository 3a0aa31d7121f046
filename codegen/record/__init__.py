"""What a run leaves behind: columns, signals, measures, tables."""
