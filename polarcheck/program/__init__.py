"""From the bytes of a file to executed rows: reading, machines and jobs, execution."""
