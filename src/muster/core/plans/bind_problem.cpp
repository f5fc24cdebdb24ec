#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "bindings.hpp"
#include "plans/problem.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const bool, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::int32_t, nb::c_contig, nb::device::cpu>;

std::vector<double> numbers(const Numbers& array) { return {array.data(), array.data() + array.size()}; }
std::vector<char> flags(const Flags& array) { return {array.data(), array.data() + array.size()}; }

Objective objective_of(const std::string& name) {
  if (name == "total") return Objective::total;
  if (name == "max") return Objective::max;
  if (name == "total+max") return Objective::total_max;
  if (name == "average") return Objective::average;
  if (name == "makespan") return Objective::makespan;
  if (name == "lateness") return Objective::lateness;
  throw std::invalid_argument("no such objective: " + name);
}

Rows rows(const std::vector<std::vector<int>>& lists) {
  Rows result;
  for (const auto& list : lists) {
    result.values.insert(result.values.end(), list.begin(), list.end());
    result.first.push_back(static_cast<int>(result.values.size()));
  }
  return result;
}

using Openings = std::vector<std::vector<std::pair<double, double>>>;
using Parts = std::vector<std::vector<std::pair<int, std::vector<bool>>>>;

std::vector<std::vector<Opening>> openings_of(const Openings& openings) {
  std::vector<std::vector<Opening>> result;
  for (const auto& row : openings) {
    auto& own = result.emplace_back();
    for (const auto& [open, close] : row) own.push_back({open, close});
  }
  return result;
}

using Stations = std::vector<std::tuple<double, double, bool, bool, int>>;

std::vector<Station> stations_of(const Stations& stations) {
  std::vector<Station> result;
  for (const auto& [refill, swap_s, unloads, partial, slots] : stations) {
    result.push_back({refill, swap_s, unloads, partial, slots});
  }
  return result;
}

std::vector<std::vector<TeamPart>> parts_of(const Parts& parts) {
  std::vector<std::vector<TeamPart>> result;
  for (const auto& row : parts) {
    auto& own = result.emplace_back();
    for (const auto& [count, allowed] : row) own.push_back({count, {allowed.begin(), allowed.end()}});
  }
  return result;
}

}  // namespace

void bind_problem(nb::module_& m) {
  nb::class_<Problem>(m, "Problem", "The compiled question: arrays that no algorithm changes.")
      .def(
          "__init__",
          [](Problem* self, const std::string& objective, bool usage_is_time, Numbers capacity, Numbers speed,
             Numbers available_from, Flags must_end, Indices fixed, Numbers actuation_cost, Indices work_class,
             Numbers work_seconds, Indices time_class, Numbers priority, Indices kind, Flags allowed,
             const std::vector<std::vector<int>>& prerequisites, Numbers entry, Numbers exit, Indices place_class,
             Numbers table, Indices travel_class, Numbers seconds, const Openings& openings, Numbers ends_by,
             Numbers due, Numbers over_by, Numbers lasts_most, const Openings& spans, Numbers gap_least,
             Numbers gap_most, Indices unit, const Parts& parts, Numbers abilities, Numbers needs,
             const std::vector<std::vector<int>>& exclusive, const std::vector<std::vector<int>>& same_crew,
             const std::vector<std::vector<int>>& apart, Indices least_stops, Numbers acceleration, Numbers climb,
             Numbers turn, bool over_map, bool makespan_includes_return, int meters, Numbers load, Numbers pending,
             Indices pickup, Numbers most_aboard, Numbers aboard_at_start, Numbers pending_at_start, Numbers energy,
             Numbers energy_at_start, const Stations& stations, Flags calls, Flags over, Numbers waiting, Flags waits) {
            const bool table_fits = table.size() == 0 || table.ndim() == 3;
            if (allowed.ndim() != 2 || actuation_cost.ndim() != 2 || kind.size() != capacity.size() ||
                entry.ndim() != 3 || entry.shape(2) != 3 || exit.ndim() != 3 || exit.shape(2) != 3 || !table_fits) {
              throw std::invalid_argument("an array has the wrong shape");
            }
            ProblemData data;
            data.objective = objective_of(objective);
            data.usage_is_time = usage_is_time;
            data.capacity = numbers(capacity);
            data.speed = numbers(speed);
            data.available_from = numbers(available_from);
            data.must_end = flags(must_end);
            data.fixed.assign(fixed.data(), fixed.data() + fixed.size());
            data.actuation_cost = numbers(actuation_cost);
            data.work_class.assign(work_class.data(), work_class.data() + work_class.size());
            data.work_seconds = numbers(work_seconds);
            data.time_class.assign(time_class.data(), time_class.data() + time_class.size());
            data.priority = numbers(priority);
            data.kind.assign(kind.data(), kind.data() + kind.size());
            data.allowed = flags(allowed);
            data.prerequisites = rows(prerequisites);
            data.entry = numbers(entry);
            data.exit = numbers(exit);
            data.place_class.assign(place_class.data(), place_class.data() + place_class.size());
            data.table = numbers(table);
            data.travel_class.assign(travel_class.data(), travel_class.data() + travel_class.size());
            data.seconds = numbers(seconds);
            data.openings = openings_of(openings);
            data.ends_by = numbers(ends_by);
            data.due = numbers(due);
            data.over_by = numbers(over_by);
            data.lasts_most = numbers(lasts_most);
            data.spans = openings_of(spans);
            data.gap_least = numbers(gap_least);
            data.gap_most = numbers(gap_most);
            data.unit.assign(unit.data(), unit.data() + unit.size());
            data.parts = parts_of(parts);
            data.abilities = numbers(abilities);
            data.needs = numbers(needs);
            data.exclusive = rows(exclusive);
            data.same_crew = rows(same_crew);
            data.apart = rows(apart);
            data.least_stops.assign(least_stops.data(), least_stops.data() + least_stops.size());
            data.acceleration = numbers(acceleration);
            data.climb = numbers(climb);
            data.turn = numbers(turn);
            data.over_map = over_map;
            data.makespan_includes_return = makespan_includes_return;
            data.meters = meters;
            data.load = numbers(load);
            data.pending = numbers(pending);
            data.pickup.assign(pickup.data(), pickup.data() + pickup.size());
            data.most_aboard = numbers(most_aboard);
            data.aboard_at_start = numbers(aboard_at_start);
            data.pending_at_start = numbers(pending_at_start);
            data.energy = numbers(energy);
            data.energy_at_start = numbers(energy_at_start);
            data.calls = flags(calls);
            data.over = flags(over);
            data.stations = stations_of(stations);
            data.waiting = numbers(waiting);
            data.waits = flags(waits);
            new (self) Problem(std::move(data));
          },
          nb::kw_only(), "objective"_a, "usage_is_time"_a, "capacity"_a, "speed"_a, "available_from"_a, "must_end"_a,
          "fixed"_a, "actuation_cost"_a, "work_class"_a, "work_seconds"_a, "time_class"_a, "priority"_a, "kind"_a,
          "allowed"_a, "prerequisites"_a, "entry"_a, "exit"_a, "place_class"_a, "table"_a, "travel_class"_a,
          "seconds"_a, "openings"_a, "ends_by"_a, "due"_a, "over_by"_a, "lasts_most"_a, "spans"_a, "gap_least"_a,
          "gap_most"_a, "unit"_a, "parts"_a, "abilities"_a, "needs"_a, "exclusive"_a, "same_crew"_a, "apart"_a,
          "least_stops"_a, "acceleration"_a, "climb"_a, "turn"_a, "over_map"_a, "makespan_includes_return"_a,
          "meters"_a, "load"_a, "pending"_a, "pickup"_a, "most_aboard"_a, "aboard_at_start"_a, "pending_at_start"_a,
          "energy"_a, "energy_at_start"_a, "stations"_a, "calls"_a, "over"_a, "waiting"_a, "waits"_a,
          "Robots (m), tasks (n) and travel: `fixed` is (m,), how many tasks at the beginning of a route stay; "
          "`actuation_cost` is (work classes, n) and `work_class` (m,); `work_seconds` is (time classes, n) and "
          "`time_class` (m,); `kind` is (m,) and `allowed` (kinds, n); `entry` and `exit` are (place classes, n + 2m, "
          "3) metres in the map frame for tasks, starts and ends of robots, and `place_class` is (m,); `table`, where "
          "ways are not straight, is (classes, n + 2m, n + 2m) metres with each "
          "robot's "
          "`travel_class`; `seconds`, of its shape, how long ways take where metres do not tell. What is empty of the "
          "rest no task or robot has: by task `openings`, `ends_by`, `due`, "
          "`unit` "
          "(tasks of one begin together), `parts` of teams (count, allowed by kind), `exclusive`, `same_crew`, "
          "`apart`; by "
          "robot `over_by`, `lasts_most` (from its start to its end), `spans` in which it drives and works, "
          "`least_stops` (of a route that has any); `gap_least` and `gap_most` by prerequisite; "
          "`abilities` (m, a) and `needs` (n, a); by "
          "robot `acceleration`, `climb`, `turn` (seconds) of motion profiles, and `over_map` whether what is longer "
          "than "
          "the straight way has bends; `load` and `pending` (n, meters) what a task adds to the load, and how "
          "much "
          "of that another delivers, `pickup` (n,) the task that takes on what a task delivers, -1 for none, "
          "`most_aboard` and `aboard_at_start` (m, meters); `energy` and `energy_at_start` (m,) in the unit of "
          "usage, the reserve taken off, inf without a limit of energy; `stations` (refill by second, swap_s, unloads, "
          "partial, "
          "slots), whose places stand after the ends of robots; `over` (n,) marks tasks that stand for what was done, "
          "before "
          "which no station is called at; `waiting` (n + 2m, n + 2m) seconds for others between "
          "places, of the robots "
          "that "
          "`waits` (m,) marks. Raises ValueError if shapes do not fit.")
      .def_prop_ro("tasks", &Problem::tasks)
      .def_prop_ro("robots", &Problem::robots)
      .def_prop_ro("is_symmetric", &Problem::is_symmetric,
                   "Whether the way from a task to another costs what the way back does, for every robot.")
      .def_prop_ro("is_timed", &Problem::is_timed,
                   "Whether anything binds tasks to times, teams, relations or whole routes.");
}

}  // namespace muster
