"""What the program is measured by, on the reader's own machine: stability, and what skipping work saves."""
