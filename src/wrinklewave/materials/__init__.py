"""Materials: constitutive laws and their moduli."""
