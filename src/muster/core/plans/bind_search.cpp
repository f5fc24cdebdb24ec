#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "plans/search.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Unlocked = nb::call_guard<nb::gil_scoped_release>;

SearchSettings settings_of(double removed, int longest_string, double blink, double greatest_share, int near,
                           bool oversubscribed) {
  return {removed, longest_string, blink, greatest_share, near, oversubscribed};
}

}  // namespace

void bind_search(nb::module_& m) {
  m.def(
      "improved",
      [](const Problem& problem, const Routes& routes) {
        static_cast<void>(draft_from(problem, routes));
        return improved(problem, routes);
      },
      "problem"_a, "routes"_a, Unlocked(),
      "Routes after local search alone, with no less weight of tasks; those given where no move is for the problem's "
      "rules.");
  nb::class_<Search>(m, "Search",
                     "Ruin and recreate under simulated annealing (SISR). One thread at a time may use one.")
      .def(
          "__init__",
          [](Search* self, const Problem& problem, const Routes& start, std::uint64_t seed, double removed,
             int longest_string, double blink, double greatest_share, int near, bool oversubscribed) {
            const Draft draft = draft_from(problem, start);
            Evaluator evaluator(problem);
            Draft copy = draft;
            if (!evaluator.evaluate(copy)) throw std::invalid_argument("the routes are not admissible");
            new (self) Search(problem, start, seed,
                              settings_of(removed, longest_string, blink, greatest_share, near, oversubscribed));
          },
          "problem"_a, "start"_a, "seed"_a, nb::kw_only(), "removed"_a, "longest_string"_a, "blink"_a,
          "greatest_share"_a, "near"_a, "oversubscribed"_a = false, nb::keep_alive<1, 2>(),
          "Raises ValueError if the routes are not admissible.")
      .def("anneal", &Search::anneal, "steps"_a, "hot"_a, "cold"_a, Unlocked(),
           "So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).")
      .def("go_on_from", &Search::go_on_from, "routes"_a, Unlocked(), "Go on from these routes; the best stays.")
      .def_prop_ro("routes", &Search::routes, "With which it goes on.")
      .def_prop_ro("best", &Search::best)
      .def_prop_ro("best_weight_left_out", [](const Search& s) { return -s.best_value().weight; })
      .def_prop_ro("best_objective", [](const Search& s) { return s.best_value().objective; })
      .def_prop_ro("best_tie", [](const Search& s) { return s.best_value().tie; })
      .def_prop_ro("task_cost", &Search::task_cost,
                   "What a task costs at the start: the mean of usage, arrival or time, as the objective has it.")
      .def_prop_ro("mean_way", &Search::mean_way, "The usual way from one task to the next, in the unit of usage.");
}

}  // namespace muster
