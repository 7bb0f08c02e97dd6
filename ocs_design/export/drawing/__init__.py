"""Technical drawing of the wheel: a sheet of lines and texts, written as SVG and PDF."""
