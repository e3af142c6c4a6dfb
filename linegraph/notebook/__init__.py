"""The emitted Python loaded without a file (`functions`), and how things look in notebooks (`displays`)."""
