"""From a model to files: programs, golden vectors and languages; `emit.emit` runs all stages."""
