"""Progress of long calls: what they do, and where that is shown."""

from .tasks import CoreCallback, Task, current_task, progress, quiet, task

__all__ = ["CoreCallback", "Task", "current_task", "progress", "quiet", "task"]
