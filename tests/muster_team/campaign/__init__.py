"""Random teams in a simulated network, with faults: they agree, and nobody owns what another owns."""
