"""Formats of surfaces alone."""
