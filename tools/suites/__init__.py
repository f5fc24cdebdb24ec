"""Which tests a change needs, what `.ci/run` executes, and the map of tests from which both are computed."""
