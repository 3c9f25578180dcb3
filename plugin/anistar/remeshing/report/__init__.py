"""What a remeshing did, and what of it should make its reader look again."""

from .remesh_report import RemeshReport, report_of

__all__ = ["RemeshReport", "report_of"]
