#include "plans/routes.hpp"

#include <stdexcept>

namespace muster {

Draft draft_from(const Problem& problem, const Routes& routes) {
  if (static_cast<int>(routes.size()) != problem.robots()) throw std::invalid_argument("a route for each robot");
  std::vector<int> tasks, robots;
  std::vector<char> seen(problem.tasks(), 0);
  for (int robot = 0; robot < problem.robots(); ++robot) {
    for (const int task : routes[robot]) {
      if (task < 0 || task >= problem.tasks()) throw std::invalid_argument("no such task");
      if (seen[task]++) throw std::invalid_argument("a task stands twice");
      tasks.push_back(task);
      robots.push_back(robot);
    }
  }
  Draft draft(problem);
  draft.assign(tasks, robots);
  return draft;
}

Routes routes_of(const Problem& problem, const Draft& draft) {
  Routes routes;
  for (int robot = 0; robot < problem.robots(); ++robot) {
    const auto route = draft.route(robot);
    routes.emplace_back(route.begin(), route.end());
  }
  return routes;
}

}  // namespace muster
