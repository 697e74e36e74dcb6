"""Certifies a post: its programs for each control, beside what each of them must say and do."""
