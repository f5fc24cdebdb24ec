"""The verbs `import` and `export`."""
