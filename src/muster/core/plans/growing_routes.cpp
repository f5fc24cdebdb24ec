#include "plans/growing_routes.hpp"

#include <algorithm>
#include <limits>

namespace muster {

GrowingRoutes::GrowingRoutes(const Problem& problem)
    : problem_(problem),
      waiting_(problem.tasks()),
      taken_(problem.tasks()),
      place_(problem.robots()),
      usage_(problem.robots()) {
  clear();
}

void GrowingRoutes::clear() {
  tasks_.clear();
  robots_.clear();
  std::ranges::fill(taken_, 0);
  for (int task = 0; task < problem_.tasks(); ++task) {
    waiting_[task] = static_cast<int>(problem_.prerequisites(task).size());
  }
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    place_[robot] = problem_.start(robot);
    usage_[robot] = 0.0;
  }
}

bool GrowingRoutes::can_append(int robot, int task) const {
  if (!problem_.allowed(robot, task)) return false;
  const double usage = problem_.on_to(robot, usage_[robot], place_[robot], task);
  return problem_.fits(robot, usage + problem_.end_usage(robot, task));
}

void GrowingRoutes::append(int robot, int task) {
  usage_[robot] = problem_.on_to(robot, usage_[robot], place_[robot], task);
  place_[robot] = task;
  taken_[task] = 1;
  tasks_.push_back(task);
  robots_.push_back(robot);
  for (const int dependant : problem_.dependants(task)) --waiting_[dependant];
}

int GrowingRoutes::cheapest(int task) const {
  int cheapest = Draft::kNobody;
  double least = std::numeric_limits<double>::infinity();
  for (const int robot : problem_.robots_allowed(task)) {
    const double usage = problem_.on_to(robot, usage_[robot], place_[robot], task);
    const double cost = problem_.objective() == Objective::total ? usage - usage_[robot] : usage;
    if (cost < least && problem_.fits(robot, usage + problem_.end_usage(robot, task))) {
      least = cost;
      cheapest = robot;
    }
  }
  return cheapest;
}

}  // namespace muster
