"""What CI systems need in reports: paths from the root of the repository, XML, a summary in Markdown."""
