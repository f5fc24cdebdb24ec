#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "bindings.hpp"
#include "plans/inspection.hpp"
#include "plans/routes.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Stops = std::vector<std::vector<std::tuple<int, double, double, double>>>;
using AllStops = std::vector<std::vector<std::tuple<int, double, double, double, double>>>;

std::optional<Stops> stops_of(Inspection& inspection) {
  const auto found = inspection.stops();
  if (!found) return std::nullopt;
  Stops stops;
  for (const auto& row : *found) {
    auto& own = stops.emplace_back();
    for (const StopTimes& stop : row) {
      if (stop.place < inspection.problem().tasks()) own.emplace_back(stop.place, stop.arrive, stop.begin, stop.end);
    }
  }
  return stops;
}

std::optional<AllStops> all_stops_of(Inspection& inspection) {
  const auto found = inspection.stops();
  if (!found) return std::nullopt;
  AllStops stops;
  for (const auto& row : *found) {
    auto& own = stops.emplace_back();
    for (const StopTimes& stop : row) own.emplace_back(stop.place, stop.arrive, stop.begin, stop.end, stop.refilled);
  }
  return stops;
}

}  // namespace

void bind_inspection(nb::module_& m) {
  nb::class_<Insertion>(m, "Insertion",
                        "Where a task would go in a robot's route, and the robot's usage then, in the unit of usage.")
      .def_ro("at", &Insertion::at)
      .def_ro("usage", &Insertion::usage);
  nb::class_<Inspection>(m, "Inspection",
                         "Routes with their figures, and what putting one more task into them would take. One thread "
                         "at a time may use one.")
      .def(nb::init<const Problem&, const Routes&>(), "problem"_a, "routes"_a, nb::keep_alive<1, 2>(),
           "One list of task indices for each robot. Raises ValueError if a task stands twice or does not exist.")
      .def_prop_ro("admissible", &Inspection::admissible,
                   "Whether capacities hold, no prerequisite is left out and nothing deadlocks.")
      .def_prop_ro("objective", &Inspection::objective,
                   "Whatever the capacities; None if routes and prerequisites deadlock.")
      .def_prop_ro("usages", &Inspection::usages)
      .def_prop_ro("makespan", &Inspection::makespan, "Seconds; None if routes and prerequisites deadlock.")
      .def_prop_ro(
          "stops", &stops_of,
          "By robot: task, arrival, begin and end of each stop of the earliest schedule; None if there is none.")
      .def_prop_ro("all_stops", &all_stops_of,
                   "The same with those at stations: place, arrival, begin, end and what is refilled.")
      .def("cheapest_insertion", &Inspection::cheapest_insertion, "robot"_a, "task"_a,
           nb::call_guard<nb::gil_scoped_release>(),
           "The place in the robot's route where the task adds least usage and nothing deadlocks, whatever the "
           "capacity; usage inf if there is no way to it, None if it would deadlock everywhere.");
}

}  // namespace muster
