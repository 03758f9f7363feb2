"""What several tests share: small models, independent solutions, and the ledger of verified numbers."""
