#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "move_planner.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Reach = std::vector<AnnotatedRoadmap::Near>;
using Planned = std::tuple<std::string, std::vector<std::pair<int, int>>, Configuration, std::vector<bool>>;

Reach reach(const std::vector<int>& points, const std::vector<double>& metres) {
  if (points.size() != metres.size()) throw std::invalid_argument("points that are near need distances");
  Reach near;
  for (std::size_t k = 0; k < points.size(); ++k) near.push_back({points[k], metres[k]});
  return near;
}

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
      .def(
          "__init__",
          [](MovePlanner* self, const PointArray& points, std::vector<int> first, std::vector<int> heads,
             std::vector<double> costs, std::vector<int> near_first, const std::vector<int>& near_points,
             const std::vector<double>& near_metres) {
            DirectedGraph graph(std::move(first), std::move(heads), std::move(costs));
            new (self) MovePlanner(std::make_shared<AnnotatedRoadmap>(
                points_of(points), std::move(graph), std::move(near_first), reach(near_points, near_metres)));
          },
          "points"_a, "first"_a, "heads"_a, "costs"_a, "near_first"_a, "near_points"_a, "near_metres"_a,
          "`points` is (n, 2); edges and what is near them are in compressed rows. Raises ValueError where they do not "
          "fit.")
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
