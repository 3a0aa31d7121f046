"""Systems of expressions solved as a person would write them: small inverses, blocks, loops of laws, steps by name."""
