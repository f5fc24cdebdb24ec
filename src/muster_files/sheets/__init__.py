"""What crews print and take along: sheets of robots, an overview, a workbook, calendars; all made from one content."""
