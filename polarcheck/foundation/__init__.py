"""What every room needs: array types, errors, bounds, time and memory, the contract of findings."""
