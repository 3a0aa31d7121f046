"""Systems of expressions solved as a person would write them: blocks, loops of laws, steps by name."""
