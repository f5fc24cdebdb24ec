#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "station_calls.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

void bind_station_calls(nb::module_& m) {
  m.def(
      "usage_with_calls",
      [](const Problem& problem, const std::vector<int>& pickups) {
        std::vector<double> usages;
        {
          const nb::gil_scoped_release release;
          usages = usage_with_calls(problem, pickups);
        }
        return table_of(std::move(usages), static_cast<std::size_t>(problem.robots()),
                        static_cast<std::size_t>(problem.tasks()));
      },
      "problem"_a, "pickups"_a,
      "(m, n) what a route with one task uses with its calls at stations, and with the task whose load it delivers "
      "(`pickups`, (n,), -1: none), or that delivers its load; inf where the robot runs short.");
}

}  // namespace muster
