"""Parts of reports for CI systems: paths from the root of the repository, XML, a summary in Markdown."""
