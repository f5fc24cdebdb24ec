// What must hold of whole plans: of routes that others made, and of those that nothing more comes to.
#include <algorithm>
#include <vector>

#include "roster.hpp"
#include "team_choice.hpp"

namespace muster {

// The robots that do a task, in order.
std::vector<int> Roster::team_of(int task) const {
  std::vector<int> team;
  for (const int number : timeline_.visits_of(problem_.unit(task))) {
    if (timeline_.visit(number).place == task) team.push_back(timeline_.visit(number).robot);
  }
  std::ranges::sort(team);
  return team;
}

bool Roster::keeps_rules() const {
  TeamChoice choice(problem_);
  for (int task = 0; task < problem_.tasks(); ++task) {
    const int unit = problem_.unit(task);
    if (!present(unit)) continue;
    const std::vector<int> team = team_of(task);
    if (!ready(unit) || !choice.does(task, team)) return false;
    if (!std::ranges::all_of(team, [&](int robot) { return problem_.allowed(robot, task); })) return false;
    for (const int other : problem_.same_robot(task)) {
      if (present(problem_.unit(other)) && team_of(other) != team) return false;
    }
    for (const int other : problem_.other_robot(task)) {
      std::vector<int> common;
      std::ranges::set_intersection(team, team_of(other), std::back_inserter(common));
      if (!common.empty()) return false;
    }
  }
  return true;
}

void Roster::drop_orphans() {
  if (!problem_.has_prerequisites() || absent_.empty()) return;
  std::vector<int> gone = absent_;
  for (std::size_t k = 0; k < gone.size(); ++k) {
    for (const int task : problem_.tasks_of_unit(gone[k])) {
      for (const int dependant : problem_.dependants(task)) {
        const int unit = problem_.unit(dependant);
        if (!present(unit)) continue;
        remove(unit);
        gone.push_back(unit);
      }
    }
  }
}

bool Roster::finish(const Trial&) {
  drop_orphans();
  return settle_begins();
}

}  // namespace muster
