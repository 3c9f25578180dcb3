"""Flags of `anistar metric` for metrics that do not come from fields alone."""
