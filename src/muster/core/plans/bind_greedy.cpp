#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "plans/greedy.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

void bind_greedy(nb::module_& m) {
  nb::class_<Matching>(m, "Matching", "One robot, one task, and the cost c_ij (3.8) of going there and doing it.")
      .def_ro("robot", &Matching::robot)
      .def_ro("task", &Matching::task)
      .def_ro("cost", &Matching::cost);
  nb::class_<Greedy>(
      m, "Greedy",
      "State and steps of greedy task allocation ([tcf-thesis], Algorithm 1). One thread at a time may use one.")
      .def(nb::init<const Problem&, bool>(), "problem"_a, "balanced"_a, nb::keep_alive<1, 2>(),
           "`balanced`: choose by c_ij + u_i (3.17), else by c_ij alone (3.27).")
      .def("select", &Greedy::select, nb::call_guard<nb::gil_scoped_release>(),
           "Steps 2 to 5: the locally optimal admissible matching, or None.")
      .def("assign", &Greedy::assign, "robot"_a, "task"_a, nb::call_guard<nb::gil_scoped_release>(),
           "Steps 6 to 8: append the task to the robot's route and go there.")
      .def_prop_ro("routes", &Greedy::routes);
}

}  // namespace muster
