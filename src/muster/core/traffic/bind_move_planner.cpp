#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "bindings.hpp"
#include "traffic/move_planner.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Planned = std::tuple<std::string, std::vector<std::pair<int, int>>, Configuration, std::vector<bool>>;

const char* name_of(MovePlan::Outcome outcome) {
  switch (outcome) {
    case MovePlan::Outcome::kArrived:
      return "arrived";
    case MovePlan::Outcome::kHorizon:
      return "horizon";
    case MovePlan::Outcome::kUnfinished:
      return "unfinished";
    default:
      return "impossible";
  }
}

Planned planned(MovePlanner& planner, MovingTeam team, const MovePlanner::Limits& limits, std::uint64_t seed) {
  const MovePlan plan = [&] {
    const nb::gil_scoped_release unlocked;
    return planner.plan(std::move(team), limits, seed);
  }();
  std::vector<std::pair<int, int>> moves;
  for (const auto [robot, edge] : plan.moves) moves.push_back({robot, edge});
  return {name_of(plan.outcome), moves, plan.places, {plan.arrived.begin(), plan.arrived.end()}};
}

}  // namespace

void bind_move_planner(nb::module_& m) {
  nb::class_<MovePlanner>(m, "MovePlanner",
                          "Sequences of single moves of a team on a roadmap with annotated conflicts.")
      .def(nb::init<std::shared_ptr<const AnnotatedRoadmap>>(), "roadmap"_a)
      .def(
          "planned",
          [](MovePlanner& self, Configuration starts, std::vector<int> goals, std::vector<double> radii,
             std::vector<double> priorities, const std::vector<bool>& pinned, double margin, double turn_cost,
             int horizon, bool settle, int expansions, int tries, std::uint64_t seed) {
            std::vector<char> arrived(starts.size());
            return planned(self,
                           {std::move(starts),
                            std::move(goals),
                            std::move(radii),
                            std::move(priorities),
                            {pinned.begin(), pinned.end()},
                            std::move(arrived),
                            margin,
                            turn_cost},
                           {horizon, expansions, settle, tries}, seed);
          },
          "starts"_a, "goals"_a, "radii"_a, "priorities"_a, "pinned"_a, nb::kw_only(), "margin"_a, "turn_cost"_a,
          "horizon"_a, "settle"_a, "expansions"_a, "tries"_a, "seed"_a,
          "The outcome (arrived, horizon, unfinished, impossible), the moves (robot, edge), where all stand in the "
          "end, "
          "and who has been at its goal.")
      .def_prop_ro("tables", &MovePlanner::tables, "The number of goals to which it knows the ways.");
}

}  // namespace muster
