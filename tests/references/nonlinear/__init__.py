"""The judge of graphs with laws, moving values and tables: all equations at once, none eliminated."""
