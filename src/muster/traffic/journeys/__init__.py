"""Journeys on a roadmap: moves of travellers through their stops, how long they take, and delays in passages."""
