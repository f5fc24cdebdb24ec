"""The view *Plan*: a mission, which `pages.editing` shows, its plans, and their explanations.

| part | what it does |
|---|---|
| `view`, `title_bar`, `versions` | the page of a mission; its head; its versions |
| `planning_controls` | asks for plans |
| `plan_panel`, `shown_plan`, `figures`, `explanation` | the shown plan: routes, figures, reasons |
| `plan_actions`, `heights_form`, `start_run` | what is done with a plan: exports, a run |
| `compare` | the page of two plans of one mission |
"""

from muster_control.pages.plan import compare, view

__all__ = ["compare", "view"]
