"""Metrics that come from elsewhere than fields: sizes, boundaries, goals, indicators."""
