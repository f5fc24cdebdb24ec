// Ctrl-C while the core is at work.
#pragma once

#include <nanobind/nanobind.h>

namespace muster {

// Raises what Python's handlers of signals raise. Called without the GIL; does nothing but on Python's main thread.
inline void hear_signals() {
  const nanobind::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

}  // namespace muster
