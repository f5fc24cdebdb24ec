#include "plans/problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace muster {

namespace {

// Straight-line tables up to this many places (2 MB); beyond it a distance is computed sooner than it comes from
// memory.
constexpr int kMostPlacesInTable = 512;

Rows transposed(const Rows& rows) {
  Rows result;
  result.first.assign(rows.first.size(), 0);
  for (const int value : rows.values) ++result.first[value + 1];
  for (std::size_t i = 1; i < result.first.size(); ++i) result.first[i] += result.first[i - 1];
  result.values.resize(rows.values.size());
  std::vector<int> at(result.first.begin(), result.first.end() - 1);
  for (int i = 0; i < rows.size(); ++i) {
    for (const int value : rows[i]) result.values[at[value]++] = i;
  }
  return result;
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace

Problem::Problem(ProblemData data)
    : data_(std::move(data)),
      tasks_(static_cast<int>(data_.priority.size())),
      robots_(static_cast<int>(data_.capacity.size())),
      places_(tasks_ + 2 * robots_ + static_cast<int>(data_.stations.size())),
      classes_(1),
      given_table_(!data_.table.empty()),
      steady_(data_.turn.empty() && data_.seconds.empty() && data_.waiting.empty()),
      usage_is_metres_(!data_.usage_is_time && data_.waiting.empty()) {
  const auto tasks = static_cast<std::size_t>(tasks_), robots = static_cast<std::size_t>(robots_);
  const auto places = static_cast<std::size_t>(places_);
  require(robots > 0, "a problem needs a robot");
  require(data_.speed.size() == robots && data_.available_from.size() == robots && data_.must_end.size() == robots &&
              data_.fixed.size() == robots,
          "arrays of robots differ in length");
  require(std::ranges::all_of(data_.fixed, [](int count) { return count >= 0; }),
          "a number of fixed tasks is negative");
  require(data_.kind.size() == robots, "kinds need a value for each robot");
  require(data_.work_class.size() == robots, "work classes need a value for each robot");
  require(std::ranges::all_of(data_.work_class, [](int c) { return c >= 0; }), "a work class is negative");
  require(data_.actuation_cost.size() ==
              (1 + static_cast<std::size_t>(*std::ranges::max_element(data_.work_class))) * tasks,
          "actuation costs have the wrong size");
  require(data_.time_class.size() == robots, "time classes need a value for each robot");
  require(std::ranges::all_of(data_.time_class, [](int c) { return c >= 0; }), "a time class is negative");
  require(
      data_.work_seconds.size() == (1 + static_cast<std::size_t>(*std::ranges::max_element(data_.time_class))) * tasks,
      "times of work have the wrong size");
  require(std::ranges::all_of(data_.kind, [](int k) { return k >= 0; }), "a kind is negative");
  require(data_.allowed.size() == (1 + static_cast<std::size_t>(*std::ranges::max_element(data_.kind))) * tasks,
          "what kinds may do has the wrong size");
  require(data_.prerequisites.first.size() == tasks + 1, "prerequisites need a row for each task");
  require(std::ranges::all_of(data_.prerequisites.values, [&](int j) { return 0 <= j && j < tasks_; }),
          "a prerequisite is no task");
  require(data_.place_class.size() == robots, "place classes need a value for each robot");
  require(std::ranges::all_of(data_.place_class, [](int c) { return c >= 0; }), "a place class is negative");
  const std::size_t drawn = (1 + static_cast<std::size_t>(*std::ranges::max_element(data_.place_class))) * places;
  require(data_.entry.size() == 3 * drawn && data_.exit.size() == 3 * drawn, "coordinates need a row for each place");
  if (!data_.table.empty()) {
    require(data_.travel_class.size() == robots, "travel classes need a value for each robot");
    require(std::ranges::all_of(data_.travel_class, [](int c) { return c >= 0; }), "a travel class is negative");
    classes_ = 1 + *std::ranges::max_element(data_.travel_class);
    require(data_.table.size() == classes_ * places * places, "the travel table has the wrong size");
    require(data_.seconds.empty() || data_.seconds.size() == data_.table.size(), "the times do not fit the table");
  }
  check_times();
  check_goods();
  dependants_ = transposed(data_.prerequisites);
  find_robots_allowed();
  find_units();
  find_transports();
  find_who_may_run_short();
  find_twins();
  symmetric_ = find_symmetric();
  if (data_.table.empty() && places_ <= kMostPlacesInTable) {
    std::vector<double> table(places * places);
    for (int from = 0; from < places_; ++from) {
      for (int to = 0; to < places_; ++to) table[from * places + to] = straight(from, to);
    }
    data_.table = std::move(table);
  }
}

bool Problem::find_symmetric() const {
  const auto same_back = [&](const double* table) {
    for (std::size_t from = 0; from < static_cast<std::size_t>(tasks_); ++from) {
      for (std::size_t to = 0; to < from; ++to) {
        if (table[from * places_ + to] != table[to * places_ + from]) return false;
      }
    }
    return true;
  };
  const auto places = static_cast<std::size_t>(places_);
  if (!data_.waiting.empty() && !same_back(data_.waiting.data())) return false;
  for (std::size_t at = 0; at < data_.table.size(); at += places * places) {
    if (!same_back(&data_.table[at])) return false;
    if (!data_.seconds.empty() && !same_back(&data_.seconds[at])) return false;
  }
  if (!data_.table.empty() && (data_.turn.empty() || !data_.seconds.empty())) return true;
  for (std::size_t first = 0; first < data_.entry.size(); first += 3 * places) {
    const auto tasks = static_cast<std::ptrdiff_t>(3) * tasks_;
    if (!std::equal(&data_.entry[first], &data_.entry[first] + tasks, &data_.exit[first])) return false;
  }
  return true;
}

bool Problem::call_alike(int robot, int other) const {
  const auto calls = [&](int own) { return data_.calls.begin() + static_cast<std::ptrdiff_t>(own) * stations(); };
  return data_.calls.empty() || std::equal(calls(robot), calls(robot) + stations(), calls(other));
}

// Whether two robots may do the same tasks, and one way costs both the same.
bool Problem::alike(int robot, int other) const {
  const auto same = [&](const auto& values) { return values.empty() || values[robot] == values[other]; };
  const auto same_loads = [&] {
    for (int c = 0; c < data_.meters; ++c) {
      if (most_aboard(robot, c) != most_aboard(other, c) || aboard_at_start(robot, c) != aboard_at_start(other, c)) {
        return false;
      }
    }
    return true;
  };
  return same(data_.kind) && same(data_.work_class) && same(data_.time_class) && same(data_.travel_class) &&
         same(data_.place_class) && same(data_.speed) && same(data_.acceleration) && same(data_.climb) &&
         same(data_.turn) && same(data_.waits) && same(data_.energy) && same(data_.energy_at_start) && same_loads() &&
         call_alike(robot, other);
}

void Problem::check_times() const {
  const auto tasks = static_cast<std::size_t>(tasks_), robots = static_cast<std::size_t>(robots_);
  const auto fits = [](std::size_t size, std::size_t expected) { return size == 0 || size == expected; };
  require(fits(data_.openings.size(), tasks) && fits(data_.ends_by.size(), tasks) && fits(data_.due.size(), tasks) &&
              fits(data_.unit.size(), tasks) && fits(data_.parts.size(), tasks),
          "times of tasks need a value for each task");
  require(fits(data_.over_by.size(), robots), "ends of routes need a value for each robot");
  require(fits(data_.lasts_most.size(), robots) && fits(data_.spans.size(), robots),
          "greatest lengths of routes, and spans, need a value for each robot");
  require(fits(data_.least_stops.size(), robots), "least numbers of tasks need a value for each robot");
  const std::size_t edges = data_.prerequisites.values.size();
  require(fits(data_.gap_least.size(), edges) && fits(data_.gap_most.size(), edges),
          "gaps need a value for each prerequisite");
  const std::size_t abilities = tasks ? data_.needs.size() / tasks : 0;
  require(data_.needs.size() == abilities * tasks && data_.abilities.size() == abilities * robots,
          "abilities have the wrong size");
  for (const Rows* relation : {&data_.exclusive, &data_.same_crew, &data_.apart}) {
    require(fits(relation->values.empty() ? 0 : static_cast<std::size_t>(relation->size()), tasks) &&
                std::ranges::all_of(relation->values, [&](int j) { return 0 <= j && j < tasks_; }),
            "relations need a row for each task");
  }
  require(fits(data_.calls.size(), robots * data_.stations.size()), "calls need a flag for each robot and station");
  require(fits(data_.over.size(), tasks), "over needs a flag for each task");
  const std::size_t kinds = tasks ? data_.allowed.size() / tasks : 0;
  for (const auto& row : data_.parts) {
    require(std::ranges::all_of(row, [&](const TeamPart& part) { return part.allowed.size() == kinds; }),
            "a part of a team needs a flag for each kind");
  }
  require(fits(data_.acceleration.size(), robots) && data_.climb.size() == data_.acceleration.size() &&
              data_.turn.size() == data_.acceleration.size(),
          "motion profiles need a value for each robot");
  require(fits(data_.waiting.size(), static_cast<std::size_t>(places_) * places_) &&
              data_.waits.size() == (data_.waiting.empty() ? 0 : robots) &&
              std::ranges::all_of(data_.waiting, [](double seconds) { return seconds >= 0.0; }),
          "waiting needs at least 0 s for each pair of places, and a flag for each robot");
}

void Problem::check_goods() const {
  const auto tasks = static_cast<std::size_t>(tasks_), robots = static_cast<std::size_t>(robots_);
  const auto meters = static_cast<std::size_t>(data_.meters);
  require(data_.load.size() == tasks * meters && data_.pending.size() == tasks * meters &&
              data_.most_aboard.size() == robots * meters && data_.aboard_at_start.size() == robots * meters &&
              (data_.pending_at_start.empty() || data_.pending_at_start.size() == robots * meters),
          "loads need a value for each meter");
  require(data_.pickup.empty() ||
              (data_.pickup.size() == tasks && std::ranges::all_of(data_.pickup, [&](int j) { return j < tasks_; })),
          "deliveries need a task for each task");
  require(
      data_.energy.size() == data_.energy_at_start.size() && (data_.energy.empty() || data_.energy.size() == robots),
      "energies need a value for each robot");
}

void Problem::find_transports() {
  if (data_.pickup.empty()) return;
  partner_.assign(tasks_, -1);
  for (int task = 0; task < tasks_; ++task) {
    if (const int pickup = data_.pickup[task]; pickup >= 0) {
      partner_[task] = pickup;
      partner_[pickup] = task;
    }
  }
  find_inseparable();
}

// The strongly connected components of the graph in which a unit leads to those that must be in the plan with it.
void Problem::find_inseparable() {
  std::vector<std::vector<int>> needs(units()), needed(units()), whole(units());
  const auto arc = [&](int from, int to) {
    if (from == to) return;
    needs[from].push_back(to);
    needed[to].push_back(from);
  };
  for (int task = 0; task < tasks_; ++task) {
    for (const int earlier : prerequisites(task)) arc(unit(task), unit(earlier));
    if (partner_[task] >= 0) arc(unit(task), unit(partner_[task]));
  }
  std::vector<int> ahead(units(), -1), behind(units(), -1);  // the last task from which a unit was reached
  const auto reach = [&](int task, const std::vector<std::vector<int>>& next, std::vector<int>& from) {
    std::vector<int> found{unit(task)};
    from[unit(task)] = task;
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (const int other : next[found[k]]) {
        if (std::exchange(from[other], task) != task) found.push_back(other);
      }
    }
    return found;
  };
  for (int task = 0; task < tasks_; ++task) {
    if (partner_[task] < 0 || !whole[unit(task)].empty()) continue;
    reach(task, needed, behind);
    std::vector<int> group = reach(task, needs, ahead);
    std::erase_if(group, [&](int other) { return behind[other] != task; });
    for (const int other : group) whole[other] = in_order(group);
  }
  for (const auto& group : whole) {  // none: the unit stands alone
    inseparable_.values.insert(inseparable_.values.end(), group.begin(), group.end());
    inseparable_.first.push_back(static_cast<int>(inseparable_.values.size()));
  }
}

// Units each behind those of them that it waits for.
std::vector<int> Problem::in_order(std::vector<int> units) const {
  std::vector<int> ordered;
  const auto waits = [&](int each) {
    const auto is_among_them = [&](int task) {
      return unit(task) != each && std::ranges::find(units, unit(task)) != units.end();
    };
    return std::ranges::any_of(tasks_of_unit(each), [&](int task) {
      return (delivers(task) && is_among_them(partner_[task])) ||
             std::ranges::any_of(prerequisites(task), is_among_them);
    });
  };
  while (!units.empty()) {
    const auto next = std::ranges::find_if_not(units, waits);
    if (next == units.end()) break;  // a circle, which no mission has
    ordered.push_back(*next);
    units.erase(next);
  }
  ordered.insert(ordered.end(), units.begin(), units.end());
  return ordered;
}

void Problem::find_who_may_run_short() {
  may_run_short_.assign(robots_, 0);
  unloads_at_stations_ =
      data_.meters > 0 && std::ranges::any_of(data_.stations, [](const Station& station) { return station.unloads; });
  for (int robot = 0; robot < robots_; ++robot) {
    may_run_short_[robot] = unloads_at_stations_ || energy(robot) < kInfinity;
    any_may_run_short_ |= may_run_short_[robot] != 0;
  }
  const auto energies = std::ranges::count_if(data_.energy, [](double size) { return size < kInfinity; });
  has_queues_ = std::ranges::any_of(
      data_.stations, [&](const Station& station) { return station.gives_energy() && station.slots < energies; });
}

void Problem::find_twins() {
  std::map<std::vector<double>, std::vector<int>> firsts;  // by what is quick to compare
  twins_.resize(robots_);
  for (int robot = 0; robot < robots_; ++robot) {
    std::vector<double> key{capacity(robot), available_from(robot), over_by(robot), lasts_most(robot)};
    for (const Opening& span : has_spans() ? data_.spans[robot] : Spans())
      key.insert(key.end(), {span.open, span.close});
    key.insert(key.end(), {must_end(robot) ? 1.0 : 0.0, static_cast<double>(fixed(robot)),
                           static_cast<double>(least_stops(robot))});
    for (int axis = 0; axis < 3; ++axis) key.insert(key.end(), {entry(start(robot), axis), entry(end(robot), axis)});
    for (const double able : ability(robot)) key.push_back(able);
    auto& among = firsts[key];
    const auto same =
        std::ranges::find_if(among, [&](int other) { return alike(robot, other) && same_ends(robot, other); });
    twins_[robot] = same == among.end() ? robot : *same;
    if (same == among.end()) among.push_back(robot);
  }
}

// Whether the ways from the starts and to the ends of two robots are the same, by a table.
bool Problem::same_ends(int robot, int other) const {
  if (!given_table_ && data_.waiting.empty()) return true;
  for (int place = 0; place < tasks_; ++place) {
    if (travel_usage(robot, start(robot), place) != travel_usage(other, start(other), place)) return false;
    if (travel_usage(robot, place, end(robot)) != travel_usage(other, place, end(other))) return false;
  }
  return true;
}

double Problem::leg_seconds(int robot, int from, int to, double metres) const {
  if (!data_.seconds.empty()) {
    const std::size_t row = static_cast<std::size_t>(travel_class(robot)) * places_ + from;
    return data_.seconds[row * places_ + to] + waiting(robot, from, to);
  }
  const double driven = data_.turn.empty() ? metres / data_.speed[robot] : profile_seconds(robot, from, to, metres);
  return driven + waiting(robot, from, to);
}

// The time of a leg from rest to rest by the robot's motion profile: `LegTimes.seconds` of muster.motion.leg_times.
double Problem::profile_seconds(int robot, int from, int to, double metres) const {
  constexpr double kStraight = 0.05;  // radians
  constexpr double kPieces = 3.0, kPiecesSliding = 2.0;
  if (!(metres > 0.0) || metres == kInfinity) return metres;
  const int own = data_.place_class[robot];
  const std::size_t first = static_cast<std::size_t>(own) * places_;
  const double rise = std::abs(data_.exit[3 * (first + from) + 2] - data_.entry[3 * (first + to) + 2]);
  double turned = 0.0;
  if (data_.over_map) turned = 2.0 * std::acos(std::min(1.0, straight(from, to, own) / metres));
  const double pieces = turned <= kStraight ? 1.0 : data_.turn[robot] > 0.0 ? kPieces : kPiecesSliding;
  const double turns = 1.0 + turned / (0.5 * std::numbers::pi);
  return pieces * ramped(robot, metres / pieces, rise / pieces) + data_.turn[robot] * turns;
}

double Problem::ramped(int robot, double metres, double rise) const {
  const double acceleration = data_.acceleration[robot];
  const double climbing = rise > 0.0 ? data_.climb[robot] * metres / rise : kInfinity;
  const double speed = std::min(data_.speed[robot], climbing);
  const bool reaches = metres * acceleration >= speed * speed;
  return reaches ? metres / speed + speed / acceleration : 2.0 * std::sqrt(metres / acceleration);
}

void Problem::find_units() {
  const int units = data_.unit.empty() || tasks_ == 0 ? tasks_ : 1 + *std::ranges::max_element(data_.unit);
  std::vector<std::vector<int>> tasks(units);
  for (int task = 0; task < tasks_; ++task) tasks[unit(task)].push_back(task);
  for (const auto& row : tasks) {
    tasks_of_unit_.values.insert(tasks_of_unit_.values.end(), row.begin(), row.end());
    tasks_of_unit_.first.push_back(static_cast<int>(tasks_of_unit_.values.size()));
  }
  timed_ = has_time_limits() || has_lasts_most() || !data_.gap_least.empty() || !data_.gap_most.empty() ||
           !data_.unit.empty() || !data_.parts.empty() || !data_.needs.empty() || !data_.same_crew.values.empty() ||
           !data_.apart.values.empty() || has_exclusive() || has_least_stops() || data_.meters > 0 ||
           !data_.energy.empty() || data_.objective == Objective::lateness ||
           (data_.makespan_includes_return && data_.objective == Objective::makespan);
}

void Problem::find_robots_allowed() {
  const auto kinds = tasks_ ? data_.allowed.size() / static_cast<std::size_t>(tasks_) : 0;
  std::map<std::string, int> number;
  for (int task = 0; task < tasks_; ++task) {
    std::string column;
    for (std::size_t kind = 0; kind < kinds; ++kind) column.push_back(data_.allowed[kind * tasks_ + task]);
    const auto [found, is_new] = number.emplace(column, robots_allowed_.size());
    like_.push_back(found->second);
    if (!is_new) continue;
    for (int robot = 0; robot < robots_; ++robot) {
      if (allowed(robot, task)) robots_allowed_.values.push_back(robot);
    }
    robots_allowed_.first.push_back(static_cast<int>(robots_allowed_.values.size()));
  }
}

RouteFigures Problem::walk(int robot, std::span<const int> route) const {
  RouteFigures figures;
  int place = start(robot);
  for (const int task : route) {
    figures.usage += travel_usage(robot, place, task);
    figures.arrivals += figures.usage;
    figures.usage += work_usage(robot, task);
    place = task;
  }
  if (!route.empty()) figures.usage += end_usage(robot, place);
  return figures;
}

double Problem::growth(int robot, std::span<const int> route, int task, int at) const {
  const int before = at ? route[at - 1] : start(robot);
  const double there = travel_usage(robot, before, task) + work_usage(robot, task);
  if (at < static_cast<int>(route.size())) {
    return there + travel_usage(robot, task, route[at]) - travel_usage(robot, before, route[at]);
  }
  return there + end_usage(robot, task) - (route.empty() ? 0.0 : end_usage(robot, before));
}

}  // namespace muster
