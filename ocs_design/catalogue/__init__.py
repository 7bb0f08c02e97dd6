"""Catalogue of parts to choose from, each row with its source."""
