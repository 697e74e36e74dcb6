"""What the readers of reports in CI ask for: paths from the root of the repository, XML, a summary in Markdown."""
