"""What would have to change: conflicts of tasks that no plan does together, and the least changes that lift rules."""
