"""Independent routes to the numbers that emitted code computes: golden vectors and `linegraph check`."""
