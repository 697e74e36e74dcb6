"""What the reader itself cannot accept."""
