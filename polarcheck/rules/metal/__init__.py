"""Rules about the metal: what stands, what the cutter touches and what it takes off."""
