"""Why a plan leaves a task out, and what one more task would do to its routes."""
