#include "traffic/seconds_to_goal.hpp"

#include <algorithm>

#include "infinity.hpp"

namespace muster {

namespace {}  // namespace

SecondsToGoal::SecondsToGoal(const AnnotatedRoadmap& roadmap, const Manner& manner, int goal)
    : roadmap_(roadmap),
      manner_(manner),
      goal_(goal),
      least_(roadmap.graph().edges(), kNever),
      settled_(roadmap.graph().edges()) {
  for (const int edge : roadmap_.graph().entering(goal)) {
    least_[edge] = 0.0;
    queue_.push({0.0, edge});
  }
}

double SecondsToGoal::from_edge(int edge) {
  while (!settled_[edge] && !queue_.empty()) settle_next();
  return least_[edge];
}

double SecondsToGoal::from_point(int point) {
  if (point == goal_) return 0.0;
  double least = kNever;
  for (int edge = roadmap_.graph().begin(point); edge < roadmap_.graph().end(point); ++edge)
    least = std::min(least, manner_.setting_out(0.0) + manner_.along(roadmap_, edge) + from_edge(edge));
  return least;
}

void SecondsToGoal::settle_next() {
  const int edge = queue_.pop().edge;
  if (settled_[edge]) return;
  settled_[edge] = true;
  const double here = least_[edge] + manner_.along(roadmap_, edge);
  for (const int before : roadmap_.graph().entering(roadmap_.graph().tail(edge))) {
    const double from = here + manner_.turning(roadmap_.turn(before, edge));
    if (from >= least_[before]) continue;
    least_[before] = from;
    queue_.push({from, before});
  }
}

}  // namespace muster
