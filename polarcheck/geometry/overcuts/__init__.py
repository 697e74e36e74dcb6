"""Where the tool center comes nearer than R to a finished part, and the cheap tests that come before that search."""
