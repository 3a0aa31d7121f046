"""Systems of expressions solved as a person would write them: small inverses, blocks, steps by name."""
