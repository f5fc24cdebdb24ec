#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "plans/schedule_search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Unlocked = nb::call_guard<nb::gil_scoped_release>;

}  // namespace

void bind_schedule_search(nb::module_& m) {
  nb::class_<ScheduleSearch>(
      m, "ScheduleSearch",
      "Ruin and recreate under simulated annealing (SISR), where tasks are bound to times, teams "
      "and relations. One thread at a time may use one.")
      .def(
          "__init__",
          [](ScheduleSearch* self, const Problem& problem, const Routes& start, std::uint64_t seed, double removed,
             int longest_string, double blink, double greatest_share, int near) {
            const SearchSettings settings{removed, longest_string, blink, greatest_share, near};
            new (self) ScheduleSearch(problem, start, seed, settings);
          },
          "problem"_a, "start"_a, "seed"_a, nb::kw_only(), "removed"_a, "longest_string"_a, "blink"_a,
          "greatest_share"_a, "near"_a, nb::keep_alive<1, 2>(),
          "Begins with the routes and what they leave room for. Raises ValueError if there is no schedule for them.")
      .def("anneal", &ScheduleSearch::anneal, "steps"_a, "hot"_a, "cold"_a, Unlocked(),
           "So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).")
      .def("go_on_from", &ScheduleSearch::go_on_from, "routes"_a, Unlocked(),
           "Go on from these routes; the best stays.")
      .def_prop_ro("routes", &ScheduleSearch::routes, "With which it goes on.")
      .def_prop_ro("best", &ScheduleSearch::best)
      .def_prop_ro("best_weight_left_out", [](const ScheduleSearch& s) { return -s.best_value().weight; })
      .def_prop_ro("best_objective", [](const ScheduleSearch& s) { return s.best_value().objective; })
      .def_prop_ro("best_tie", [](const ScheduleSearch& s) { return s.best_value().tie; })
      .def_prop_ro("mean_way", &ScheduleSearch::mean_way,
                   "The usual way from one task to the next, in the unit of the objective.");
}

}  // namespace muster
