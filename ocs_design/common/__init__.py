"""What every part of the package uses: units, errors, arrays, files."""
