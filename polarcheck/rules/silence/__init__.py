"""Allow comments, with which a program answers for a finding."""
