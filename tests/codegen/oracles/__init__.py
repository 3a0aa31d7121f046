"""What the tests of the numeric side compare with: small models and independent solutions."""
