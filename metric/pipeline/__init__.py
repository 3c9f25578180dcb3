"""From fields to a metric: the stages in their order, and the target that they meet."""
