"""What the program is measured by, on the reader's own machine: errors, run times, stability."""
