// What must hold of routes that others made.
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

}  // namespace muster
