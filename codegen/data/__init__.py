"""Tables that others wrote: files and frames as columns of numbers."""
