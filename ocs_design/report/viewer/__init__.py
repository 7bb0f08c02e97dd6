"""The robot in three dimensions on a web page: its surfaces, small enough to be mailed."""
