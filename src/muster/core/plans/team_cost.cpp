#include "plans/team_cost.hpp"

#include <algorithm>

namespace muster {

TeamCost::TeamCost(const Problem& problem, Team& team)
    : problem_(problem),
      team_(team),
      sees_greatest_(problem.objective() != Objective::total && problem.objective() != Objective::average),
      sees_total_(problem.objective() != Objective::max && problem.objective() != Objective::makespan),
      tie_(0.01) {}

void TeamCost::weigh_total(double weight) { tie_ = weight; }

double TeamCost::load(int robot) const {
  if (problem_.objective() != Objective::makespan) return team_.usage(robot);
  return team_.empty(robot) ? 0.0 : team_.done(robot);
}

int TeamCost::greatest() const {
  int greatest = 0;
  for (int robot = 1; robot < problem_.robots(); ++robot) {
    if (load(robot) > load(greatest)) greatest = robot;
  }
  return greatest;
}

double TeamCost::objective() const {
  double total = 0.0, most = 0.0, arrivals = 0.0;
  const bool average = problem_.objective() == Objective::average;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    total += team_.usage(robot);
    most = std::max(most, load(robot));
    if (average) arrivals += team_.arrivals(robot);
  }
  switch (problem_.objective()) {
    case Objective::total:
      return total;
    case Objective::max:
    case Objective::makespan:
      return most;
    case Objective::average:
      return arrivals;
    default:
      return total + most;
  }
}

double TeamCost::cost() const {
  if (sees_total_) return objective();
  double total = 0.0;
  for (int robot = 0; robot < problem_.robots(); ++robot) total += team_.usage(robot);
  return objective() + tie_ * total;
}

double TeamCost::score(int robot, int task, int after, double growth, double peak) const {
  switch (problem_.objective()) {
    case Objective::max:
      return tie_ * growth + std::max(0.0, team_.usage(robot) + growth - peak);
    case Objective::total_max:
      return growth + std::max(0.0, team_.usage(robot) + growth - peak);
    case Objective::average:
      return team_.later_arrivals(robot, task, after, growth);
    case Objective::makespan: {
      const double longer = team_.longer(robot, task, after);
      return tie_ * longer + std::max(0.0, team_.done(robot) + longer - peak);
    }
    case Objective::total:
    case Objective::lateness:  // of timed problems alone, which `ScheduleSearch` is for
      break;
  }
  return growth;
}

void TeamCost::look() {
  std::ranges::fill(most_, -1);
  if (!sees_greatest_) return;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    int each = robot;
    for (int& place : most_) {
      if (each < 0) break;
      if (place < 0 || load(each) > load(place)) std::swap(place, each);
    }
  }
}

double TeamCost::change(int robot, double growth, int other, double growth_of_other) const {
  double change = (sees_total_ ? 1.0 : tie_) * (growth + growth_of_other);
  if (!sees_greatest_) return change;
  double most = 0.0;
  for (const int each : most_) {
    if (each < 0 || each == robot || each == other) continue;
    most = team_.usage(each);
    break;
  }
  most = std::max(most, team_.usage(robot) + growth);
  if (other != robot) most = std::max(most, team_.usage(other) + growth_of_other);
  return change + most - team_.usage(most_[0]);
}

}  // namespace muster
