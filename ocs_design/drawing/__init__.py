"""Technical drawings: lines and texts on a sheet, and two writers that show the same."""
