#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "traffic/safe_intervals.hpp"
#include "traffic/shared_ways.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using TimedStops = std::vector<std::pair<int, double>>;

Traveller traveller_of(int start, const TimedStops& stops, double radius, double speed, double heading, double yaw_rate,
                       double acceleration, double ready, bool fixed, bool stays) {
  if (!(radius >= 0.0 && speed > 0.0 && yaw_rate > 0.0 && acceleration > 0.0 && ready >= 0.0))
    throw std::invalid_argument("traveller: expected positive numbers");
  Traveller who{start, heading, {}, radius, speed, yaw_rate, acceleration, ready, fixed, stays};
  for (const auto& [point, hold] : stops) who.stops.push_back({point, hold});
  return who;
}

std::pair<std::vector<std::tuple<double, int, int, int>>, std::vector<double>> told(Paths paths) {
  std::vector<std::tuple<double, int, int, int>> moves;
  for (const TimedMove& move : paths.moves) moves.emplace_back(move.start, move.traveller, move.edge, move.stop);
  return {std::move(moves), std::move(paths.ends)};
}

void check(const SafeIntervals& paths, const Traveller& who) {
  const auto known = [&](int point) { return point >= 0 && point < paths.points(); };
  if (!known(who.start)) throw std::invalid_argument("start: no point of the roadmap");
  for (const Stop& stop : who.stops)
    if (!known(stop.point)) throw std::invalid_argument("stop: no point of the roadmap");
}

void check(std::vector<int> order, std::size_t travellers) {
  std::ranges::sort(order);
  bool each = order.size() == travellers;
  for (std::size_t k = 0; each && k < order.size(); ++k) each = order[k] == static_cast<int>(k);
  if (!each) throw std::invalid_argument("order: expected each traveller once");
}

void check(int ways) {
  if (ways < 0) throw std::invalid_argument("ways: expected at least 0");
}

}  // namespace

void bind_safe_intervals(nb::module_& m) {
  nb::class_<Traveller>(m, "Traveller", "A robot for which a path over a roadmap is sought.")
      .def(
          "__init__",
          [](Traveller* self, int start, const TimedStops& stops, double radius, double speed, double heading,
             double yaw_rate, double acceleration, double ready, bool fixed, bool stays) {
            new (self) Traveller(
                traveller_of(start, stops, radius, speed, heading, yaw_rate, acceleration, ready, fixed, stays));
          },
          nb::kw_only(), "start"_a, "stops"_a, "radius"_a, "speed"_a, "heading"_a, "yaw_rate"_a, "acceleration"_a,
          "ready"_a, "fixed"_a, "stays"_a);

  nb::class_<SafeIntervals>(m, "SafeIntervals",
                            "Paths in continuous time on a roadmap, one robot after the other [phillips2011].")
      .def(nb::init<std::shared_ptr<const AnnotatedRoadmap>, std::vector<bool>, double>(), "roadmap"_a, "rests"_a,
           "margin"_a, "`rests`: whether a robot may rest at a point without standing in the way of others.")
      .def(
          "metres_to",
          [](SafeIntervals& self, int goal) {
            if (goal < 0 || goal >= self.points()) throw std::invalid_argument("goal: no point of the roadmap");
            return self.metres_to(goal);
          },
          "goal"_a, "What it costs to come to a point from each; inf where there is no way.");

  nb::class_<SharedWays>(m, "SharedWays",
                         "Ways of all who share a roadmap: one after the other, then few at a time anew [li2021].")
      .def(
          "__init__",
          [](SharedWays* self, SafeIntervals& paths, const std::vector<Traveller>& travellers, std::vector<int> order,
             int ways, int expansions, std::uint64_t seed, bool at_once, std::int64_t most, double seconds) {
            for (const Traveller& who : travellers) check(paths, who);
            check(order, travellers.size());
            check(ways);
            if (expansions < 1) throw std::invalid_argument("expansions: expected at least 1");
            const nb::gil_scoped_release free;
            new (self) SharedWays(paths, travellers, std::move(order),
                                  {ways, expansions, at_once, PlanningBudget(most, seconds)}, seed);
          },
          "paths"_a, "travellers"_a, nb::kw_only(), "order"_a, "ways"_a, "expansions"_a = 300, "seed"_a,
          "at_once"_a = false, "most_expansions"_a = std::numeric_limits<std::int64_t>::max(),
          "most_seconds"_a = std::numeric_limits<double>::infinity(), nb::keep_alive<1, 2>(),
          "The first ways are sought in the order given; where some find none, or with `at_once`, all make way for "
          "each "
          "other, until so many expansions bring them no nearer to their stops. `ways` more are sought to improve "
          "them, as long as neither the expansions nor the seconds of all searches are spent.")
      .def(
          "change",
          [](SharedWays& self, const std::vector<std::pair<int, Traveller>>& changes, int ways) {
            for (const auto& [k, who] : changes) {
              check(self.roadmap(), who);
              if (k < 0 || k >= static_cast<int>(self.travellers().size()))
                throw std::invalid_argument("changes: no number of a traveller");
              if (who.fixed || self.travellers()[k].fixed) throw std::invalid_argument("changes: one is fixed");
            }
            check(ways);
            const nb::gil_scoped_release free;
            self.change(changes, ways);
          },
          "changes"_a, nb::kw_only(), "ways"_a,
          "Travellers, by number, do something else: theirs are sought anew, and `ways` more.")
      .def("undo", &SharedWays::undo, "Take the last change back.")
      .def_prop_ro("expansions", &SharedWays::expansions,
                   "Of all searches so far: labels of ways, and configurations times robots.")
      .def_prop_ro("order", &SharedWays::order, "Of the travellers, in which these ways were found.")
      .def(
          "paths", [](const SharedWays& self) { return told(self.paths()); },
          "Moves (seconds, traveller, edge, the number of the stop to which it leads) in order; and when each has held "
          "at its last stop, inf where it finds no path, NaN where those that are fixed cut it off.")
      .def(
          "paths_alone", [](const SharedWays& self) { return told(self.paths_alone()); },
          "The same of each, were it alone with those that are fixed.");
}

}  // namespace muster
