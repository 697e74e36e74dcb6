"""The executed program as columns and tables, which rules compare."""
