"""The figures of a design: each function makes charts, for the page and for files."""
