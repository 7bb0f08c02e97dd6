"""Facts in a terminal, that commands print."""
