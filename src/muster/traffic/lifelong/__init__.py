"""Lifelong multi-agent paths: instances of the League of Robot Runners, runs of them, a judge, and its output file."""
