"""What every room stands on: errors, types of arrays, whole files, processes and memory."""
