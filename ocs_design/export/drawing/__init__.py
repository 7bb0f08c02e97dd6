"""Technical drawings of wheel and plate: sheets of lines and texts, written as SVG and PDF."""
