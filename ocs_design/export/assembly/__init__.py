"""Assembly, test and wiring instructions: pictures and text for the builder."""
