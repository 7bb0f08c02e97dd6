"""Charts in SVG, for pages and as files: axes with units, few marks, colours that all can tell."""
