"""What a generation did, and how good its mesh is."""

from .generate_report import GenerateReport

__all__ = ["GenerateReport"]
