"""Reports: one self-contained HTML page, and tables for the terminal."""

from wrinklewave.report.page import ReportContext, comparison_html, write
from wrinklewave.report.tables import comparison_table, summary_table

__all__ = ["ReportContext", "comparison_html", "comparison_table", "summary_table", "write"]
