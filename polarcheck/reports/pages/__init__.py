"""Text beside findings: manual pages, machine profiles, the executed table, schemas."""
