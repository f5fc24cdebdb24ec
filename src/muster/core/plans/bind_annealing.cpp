#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>

#include "bindings.hpp"
#include "plans/annealing.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

class Annealer : public Annealing {
 public:
  Annealer(const Problem& problem, const Routes& routes, std::uint64_t seed)
      : Annealing(problem, routes, seed), problem_(problem) {}

  void anneal_route(int robot, int steps) {
    if (robot < 0 || robot >= problem_.robots()) throw std::out_of_range("no such robot");
    anneal(robot, steps);
  }
  Routes routes() const { return routes_of(problem_, draft()); }

 private:
  const Problem& problem_;
};

}  // namespace

void bind_annealing(nb::module_& m) {
  nb::class_<Annealer>(m, "Annealing",
                       "Simulated annealing of the order of tasks in single routes ([market-paper], section 3.1). One "
                       "thread at a time may use one.")
      .def(nb::init<const Problem&, const Routes&, std::uint64_t>(), "problem"_a, "routes"_a, "seed"_a,
           nb::keep_alive<1, 2>(), "Raises ValueError if the routes are not admissible.")
      .def("anneal", &Annealer::anneal_route, "robot"_a, "steps"_a, nb::call_guard<nb::gil_scoped_release>(),
           "So many steps on one robot's route. The best order found stays, unless the plan would be worse for it.")
      .def_prop_ro("routes", &Annealer::routes);
}

}  // namespace muster
