"""Bond graphs as files: written whole, read without trust."""
