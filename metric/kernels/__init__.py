"""The compiled kernels, or their NumPy counterparts where the core is not built.

With the core, results do not depend on the CPU: NumPy's own ``exp``, ``log`` and ``power``, its
``linalg`` and its products of matrices run code that is chosen by the CPU they find, and round
differently from one to the next. What NumPy does elsewhere in this package (``+ - * /``, ``sqrt``,
sums, sorting, indexing) rounds alike everywhere.
"""
