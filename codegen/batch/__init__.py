"""Many runs in one call of C."""
