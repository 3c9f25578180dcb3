"""Metric fields: which mesh do we want?"""
