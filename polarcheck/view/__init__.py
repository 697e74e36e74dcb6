"""Pages and drawings of programs: their data, small views for a terminal, the html report. Nothing here prints."""
