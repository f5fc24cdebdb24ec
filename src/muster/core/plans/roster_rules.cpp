// What must hold of whole plans: of routes that others made, and of those that nothing more comes to.
#include <algorithm>
#include <optional>
#include <vector>

#include "plans/roster.hpp"
#include "plans/team_choice.hpp"

namespace muster {

namespace {

constexpr double kFills = 0.45, kMoves = 0.9;  // shares of the ways to mend a short route

// How many tasks a robot that does some lacks; 0: it does enough, or none.
int lack(const Roster& roster, int robot) {
  const int tasks = roster.timeline().tasks_in(robot);
  return tasks == 0 ? 0 : std::max(0, roster.problem().least_stops(robot) - tasks);
}

// The robot that lacks most tasks; none: all do enough, or none.
std::optional<int> shortest_route(const Roster& roster) {
  int found = 0;
  if (!roster.problem().has_least_stops()) return std::nullopt;
  for (int robot = 1; robot < roster.problem().robots(); ++robot) {
    if (lack(roster, robot) > lack(roster, found)) found = robot;
  }
  return lack(roster, found) > 0 ? std::optional(found) : std::nullopt;
}

// Routes with too few tasks, one after the other: a robot gets more tasks from the routes around it, or none.
class ShortRoutes {
 public:
  ShortRoutes(Roster& roster, const Trial& trial)
      : roster_(roster), problem_(roster.problem()), random_(trial.random), elsewhere_(trial) {
    if (!problem_.has_least_stops()) return;
    open_.assign(problem_.robots(), 1);
    fills_ = problem_.robots();
    elsewhere_.robots = &open_;
  }
  ShortRoutes(const ShortRoutes&) = delete;
  ShortRoutes& operator=(const ShortRoutes&) = delete;

  // False: no route is too short any more, or one cannot be mended.
  bool mend_one() {
    const auto robot = shortest_route(roster_);
    if (!robot) return false;
    // Where chance decides, all is tried; only to leave tasks out cannot fail.
    const double chance = random_ ? random_->uniform() : 0.0;
    const bool fills = --fills_ >= 0 && chance < kFills;
    failed_ = fills && !fill(*robot);
    if (failed_ || lack(roster_, *robot) == 0) return !failed_;
    open_[*robot] = 0;
    failed_ = !empty(*robot, chance < kMoves);
    return !failed_;
  }

  // Whether a route is too short and cannot be mended: a task in it stays where it is, or no schedule exists.
  bool failed() const { return failed_; }

 private:
  // Gives a robot the tasks that it lacks, near ones first, as far as it can do them. False: no schedule exists.
  bool fill(int robot) {
    std::vector<char> alone(problem_.robots(), 0), tried(problem_.units(), 0);
    alone[robot] = 1;
    Trial own = elsewhere_;
    own.robots = &alone;
    while (lack(roster_, robot) > 0) {
      const auto unit = nearest_of_others(robot, tried);
      if (!unit) break;
      tried[*unit] = 1;
      roster_.remove(*unit);
      if (!roster_.settle_begins() || !insert({*unit}, {own, elsewhere_})) return false;
    }
    return true;
  }

  // Takes all tasks from a robot; if it `moves` them, they go elsewhere as far as they fit.
  bool empty(int robot, bool moves) {
    const Timeline& timeline = roster_.timeline();
    std::vector<int> units;
    for (int at = 1; at <= timeline.tasks_in(robot); ++at) units.push_back(timeline.stop(robot, at).unit);
    if (std::ranges::any_of(units, [&](int unit) { return roster_.fixed(unit); })) return false;
    for (const int unit : units) roster_.remove(unit);
    return roster_.settle_begins() && (!moves || insert(units, {elsewhere_}));
  }

  // The unit that is nearest to a robot's route, of those that may come over to it.
  std::optional<int> nearest_of_others(int robot, const std::vector<char>& tried) const {
    double nearest = kNever;
    std::optional<int> found;
    for (int task = 0; task < problem_.tasks(); ++task) {
      const int unit = problem_.unit(task);
      if (tried[unit] || !problem_.allowed(robot, task) || !may_leave(unit, robot)) continue;
      const double way = way_to(robot, task) * (random_ ? 0.5 + random_->uniform() : 1.0);
      if (way >= nearest) continue;
      nearest = way;
      found = unit;
    }
    return found;
  }

  // Whether it is a task of one other robot, which keeps enough tasks without it, or does too few anyway, and is
  // nowhere later without it.
  bool may_leave(int unit, int robot) const {
    if (!roster_.present(unit) || roster_.fixed(unit)) return false;
    const auto visits = roster_.timeline().visits_of(unit);
    if (visits.size() != 1 || !problem_.same_crew(problem_.tasks_of_unit(unit).front()).empty()) return false;
    const Visit& visit = roster_.timeline().visit(visits.front());
    const int owner = visit.robot, left = roster_.timeline().tasks_in(owner) - 1;
    const bool enough = lack(roster_, owner) > 0 || left == 0 || left >= problem_.least_stops(owner);
    return owner != robot && enough && (left == 0 || is_on_the_way(visit));
  }

  // Whether the way past a visit is not longer than the way through it.
  bool is_on_the_way(const Visit& visit) const {
    const Timeline& timeline = roster_.timeline();
    const int robot = visit.robot;
    const Visit &before = timeline.stop(robot, visit.at - 1), &after = timeline.stop(robot, visit.at + 1);
    if (after.unit < 0 && !problem_.must_end(robot)) return true;
    return problem_.travel_time(robot, before.place, after.place) <= visit.in + after.in;
  }

  // The least way to a task from a stop of the robot's route, or its start.
  double way_to(int robot, int task) const {
    double way = kNever;
    for (int at = 0; at <= roster_.timeline().tasks_in(robot); ++at) {
      const int place = roster_.timeline().stop(robot, at).place;
      way = std::min(way, problem_.distance(problem_.travel_class(robot), place, task));
    }
    return way;
  }

  // Puts units where the first of the trials finds a place that finds one. False: no schedule exists.
  bool insert(std::vector<int> units, const std::vector<Trial>& trials) {
    for (bool more = true; more;) {
      more = false;
      for (int& unit : units) {
        if (unit < 0 || roster_.present(unit) || !roster_.ready(unit)) continue;
        const UnitInsertion* insertion = nullptr;
        for (const Trial& trial : trials) {
          if (!insertion) insertion = roster_.best_insertion(unit, trial);
        }
        unit = -1;
        if (!insertion) continue;
        if (!roster_.insert(*insertion)) return false;
        more = true;
      }
    }
    return true;
  }

  Roster& roster_;
  const Problem& problem_;
  Random* random_;
  Trial elsewhere_;
  bool failed_ = false;
  int fills_ = 0;           // how many routes may still be filled, so that this ends
  std::vector<char> open_;  // by robot, whether tasks may still come to it
};

}  // namespace

std::vector<int> Roster::team_of(int task) const {
  std::vector<int> team;
  for (const int number : timeline_.visits_of(problem_.unit(task))) {
    if (timeline_.visit(number).place == task) team.push_back(timeline_.visit(number).robot);
  }
  std::ranges::sort(team);
  return team;
}

bool Roster::keeps_rules() const {
  if (shortest_route(*this)) return false;
  TeamChoice choice(problem_);
  for (int task = 0; task < problem_.tasks(); ++task) {
    const int unit = problem_.unit(task);
    if (present(unit) && (!ready(unit) || barred(unit) || !has_rightful_team(task, choice))) return false;
  }
  return true;
}

// Whether robots do a task that may, as many as it needs, and those that its relations to other tasks allow.
bool Roster::has_rightful_team(int task, TeamChoice& choice) const {
  const std::vector<int> team = team_of(task);
  if (!choice.does(task, team)) return false;
  if (const int other = problem_.partner(task); other >= 0) {
    if (!present(problem_.unit(other)) || team_of(other) != team) return false;
    if (problem_.delivers(task) && !comes_after(task, other)) return false;
  }
  if (!std::ranges::all_of(team, [&](int robot) { return problem_.allowed(robot, task); })) return false;
  for (const int other : problem_.same_crew(task)) {
    if (present(problem_.unit(other)) && team_of(other) != team) return false;
  }
  return std::ranges::none_of(problem_.apart(task), [&](int other) {
    std::vector<int> common;
    std::ranges::set_intersection(team, team_of(other), std::back_inserter(common));
    return !common.empty();
  });
}

// Whether one task comes after another in every route that has both.
bool Roster::comes_after(int task, int other) const {
  const auto later = [&](int robot) { return timeline_.place_of(task, robot) > timeline_.place_of(other, robot); };
  return std::ranges::all_of(team_of(task), later);
}

void Roster::drop_orphans() {
  if ((!problem_.has_prerequisites() && !problem_.has_deliveries()) || absent_.empty()) return;
  std::vector<int> gone = absent_;
  for (std::size_t k = 0; k < gone.size(); ++k) {
    for (const int other : problem_.inseparable(gone[k])) {
      if (!present(other)) continue;
      take_out(other);
      gone.push_back(other);
    }
    for (const int task : problem_.tasks_of_unit(gone[k])) {
      for (const int dependant : problem_.dependants(task)) {
        const int unit = problem_.unit(dependant);
        if (!present(unit)) continue;
        take_out(unit);
        gone.push_back(unit);
      }
    }
  }
}

bool Roster::finish(const Trial& trial) {
  ShortRoutes routes(*this, trial);
  do {
    drop_orphans();
    if (!settle_begins()) return false;
  } while (routes.mend_one());
  return !routes.failed();
}

}  // namespace muster
