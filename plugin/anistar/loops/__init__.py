"""The cycle of solving and adapting: one adaptation, loops, windows of time, studies."""
