#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "plans/roster.hpp"
#include "plans/unit_greedy.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

void require_unit(const Roster& roster, int unit, bool present) {
  if (unit < 0 || unit >= roster.problem().units()) throw std::invalid_argument("no such unit");
  if (roster.present(unit) != present) {
    throw std::invalid_argument(present ? "the unit is in no route" : "the unit is in routes already");
  }
}

std::optional<UnitInsertion> best_insertion(Roster& roster, int unit, bool append_only, bool quantised,
                                            const std::optional<std::vector<int>>& robots) {
  require_unit(roster, unit, false);
  Trial trial;
  trial.append_only = append_only;
  trial.quantised = quantised;
  std::vector<char> chosen;
  if (robots) {
    chosen.assign(roster.problem().robots(), 0);
    for (const int robot : *robots) chosen.at(robot) = 1;
    trial.robots = &chosen;
  }
  const UnitInsertion* best = roster.best_insertion(unit, trial);
  return best ? std::optional(*best) : std::nullopt;
}

std::vector<std::tuple<int, int, int>> members_of(const UnitInsertion& insertion) {
  std::vector<std::tuple<int, int, int>> members;
  const auto add = [&](const PlacedUnit& placed) {
    for (const Member& member : placed.members) members.emplace_back(member.task, member.robot, member.at);
  };
  add(insertion);
  for (const PlacedUnit& other : insertion.others) add(other);
  return members;
}

std::vector<std::vector<std::tuple<int, double, double, double>>> roster_stops(const Roster& roster) {
  std::vector<std::vector<std::tuple<int, double, double, double>>> stops;
  for (const auto& row : roster.stops()) {
    auto& own = stops.emplace_back();
    for (const StopTimes& stop : row) {
      if (stop.place < roster.problem().tasks()) own.emplace_back(stop.place, stop.arrive, stop.begin, stop.end);
    }
  }
  return stops;
}

}  // namespace

void bind_roster(nb::module_& m) {
  nb::class_<UnitInsertion>(m, "UnitInsertion", "A unit of work with the robots that do it, and what it costs.")
      .def_prop_ro("unit", [](const UnitInsertion& insertion) { return insertion.unit; })
      .def_ro("score", &UnitInsertion::score, "What the objective grows by, ties broken by the routes' growth.")
      .def_ro("growth", &UnitInsertion::growth, "Of usage, all members together.")
      .def_prop_ro("members", &members_of, "Task, robot and place in its route, of each.");
  nb::class_<Roster>(m, "Roster",
                     "Routes while an algorithm changes them, where tasks are bound to times, teams and relations.")
      .def(nb::init<const Problem&>(), "problem"_a, nb::keep_alive<1, 2>())
      .def("begin", &Roster::begin, "routes"_a, "Take over routes; False if there is no schedule for them.")
      .def("present", &Roster::present, "unit"_a, "Whether a unit is in routes.")
      .def("ready", &Roster::ready, "unit"_a, "Whether all that a unit waits for is in routes.")
      .def("fixed", &Roster::fixed, "unit"_a, "Whether a unit stays where it is.")
      .def_prop_ro("absent", &Roster::absent, "The units in no route.")
      .def_prop_ro("absent_weight", &Roster::absent_weight)
      .def("usage", &Roster::usage, "robot"_a)
      .def("best_insertion", &best_insertion, "unit"_a, nb::kw_only(), "append_only"_a = false, "quantised"_a = false,
           "robots"_a = nb::none(),
           "The team and the places at which a unit costs least, or None. All that it waits for must be in routes; "
           "`append_only` looks at the ends of routes alone, `robots` at these alone. `quantised` compares costs in "
           "quanta, as bids.")
      .def(
          "insert",
          [](Roster& roster, const UnitInsertion& insertion) {
            require_unit(roster, insertion.unit, false);
            return roster.insert(insertion);
          },
          "insertion"_a, "False: no schedule exists; then only `rollback` helps.")
      .def(
          "remove",
          [](Roster& roster, int unit) {
            require_unit(roster, unit, true);
            roster.remove(unit);
            return roster.settle();
          },
          "unit"_a, "False: no schedule exists; then only `rollback` helps.")
      .def(
          "finish", [](Roster& roster) { return roster.finish(); },
          "Take out what a plan cannot hold when nothing more comes to it. False: no schedule exists for the rest.")
      .def("admissible", &Roster::admissible,
           "Whether the routes changed since the last `commit` are within the robots' capacities.")
      .def("commit", &Roster::commit)
      .def("rollback", &Roster::rollback, "Undo everything since the last `commit`.")
      .def_prop_ro("objective", [](Roster& roster) { return roster.value().objective; })
      .def_prop_ro("routes", &Roster::routes)
      .def_prop_ro("stops", &roster_stops, "By robot: task, arrival, begin and end of each stop.");
  nb::class_<UnitGreedy>(m, "UnitGreedy",
                         "Greedy allocation of units of work, each to the ends of the routes where its debit is least.")
      .def(nb::init<Roster&, const std::vector<int>&, bool>(), "roster"_a, "robots"_a, "thorough"_a,
           nb::keep_alive<1, 2>(),
           "`thorough`: choose as if every unit were evaluated at each step; else mainly those near what was placed.")
      .def("append_one", &UnitGreedy::append_one, nb::call_guard<nb::gil_scoped_release>(),
           "Put the unit of the least debit into routes; False: none fits.");
}

}  // namespace muster
