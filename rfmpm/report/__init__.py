"""Figures, tables and documents made of results; the page of a campaign and the pictures of a realisation."""

from rfmpm.report.document import write
from rfmpm.report.field_page import write_field
from rfmpm.report.setup_picture import write_setup_picture
from rfmpm.report.simulation_picture import write_animation, write_simulation_picture
from rfmpm.report.stability_picture import write_stability_picture
from rfmpm.report.summary import summary_lines

__all__ = [
    "summary_lines",
    "write",
    "write_animation",
    "write_field",
    "write_setup_picture",
    "write_simulation_picture",
    "write_stability_picture",
]
