"""Run time against error: every shape with every transfer, on scenes whose answer is known."""
