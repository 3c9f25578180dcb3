"""Loops on disk: folders, locks, series of files, solvers that are commands, the HTML report."""
