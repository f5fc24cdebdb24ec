// A way to improve routes around a task: the local search tries one after the other.
#pragma once

#include <span>
#include <vector>

#include "plans/neighbours.hpp"
#include "plans/team.hpp"
#include "plans/team_cost.hpp"

namespace muster {

// What moves work on, and the tasks around which routes have changed.
class Surroundings {
 public:
  Surroundings(const Problem& for_problem, const Neighbours& neighbours, Team& of_team, TeamCost& of_cost);

  const Problem& problem;
  Team& team;
  TeamCost& cost;

  // The tasks near a task, the nearest first.
  std::span<const int> near(int task) const;
  // Whether a task may be put behind a place.
  bool open(int place) const { return !team.before(place, team.last_fixed(team.robot_of(place))); }
  bool gains(double change) const { return change < -least_gain_; }
  // Whether one route may grow so much, or two.
  bool fits(int robot, double growth) const { return growth <= 0.0 || problem.fits(robot, team.usage(robot) + growth); }

  // What a weight of tasks left out counts as cost.
  double worth(double weight) const { return penalty * weight; }
  double penalty = 0.0;

  void wake(int place);
  // A task around which something has changed, or `Team::kAbsent`.
  int next_awake();
  // Of a route that was changed: the loads are looked at again.
  template <class... Places>
  bool changed(Places... places) {
    (wake(places), ...);
    cost.look();
    return true;
  }

 private:
  const Neighbours& neighbours_;
  double least_gain_;
  std::vector<int> awake_;
  std::vector<char> is_awake_;
};

class Move {
 public:
  explicit Move(Surroundings& around) : around_(around), problem_(around.problem), team_(around.team) {}
  virtual ~Move() = default;

  // Applies the first change around a task that makes the cost less; whether there was one.
  virtual bool improve(int task) = 0;

 protected:
  double way(int robot, int from, int to) const { return team_.way(robot, from, to); }
  // What a route grows by with another task in the place of this.
  double growth_with(int task, int other) const {
    const int robot = team_.robot_of(task), before = team_.prev(task), on = team_.next(task);
    return way(robot, before, other) + problem_.work_usage(robot, other) + way(robot, other, on) - team_.way(task) -
           problem_.work_usage(robot, task) - team_.way(on);
  }

  Surroundings& around_;
  const Problem& problem_;
  Team& team_;
};

}  // namespace muster
