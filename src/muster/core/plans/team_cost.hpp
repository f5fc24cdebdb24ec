// What a search minimises of a team's routes, and what a change would add to it.
#pragma once

#include "plans/problem.hpp"
#include "plans/team.hpp"

namespace muster {

class TeamCost {
 public:
  TeamCost(const Problem& problem, Team& team);

  // What a route adds to the greatest: its usage, or the time it takes.
  double load(int robot) const;
  // The robot that does most.
  int greatest() const;
  // Of all routes; `average` as a sum.
  double objective() const;
  // With a small part of what the objective does not see.
  double cost() const;
  // What `objective` grows by with a task behind a place, if `peak` is the greatest load.
  double score(int robot, int task, int after, double growth, double peak) const;

  // The greatest loads, for `change`.
  void look();
  bool is_greatest(int robot) const { return robot == most_[0]; }
  // What `cost` grows by if the usage of two robots does, since `look`; not for `average` or `makespan`.
  double change(int robot, double growth, int other, double growth_of_other) const;
  // What a unit of the whole usage counts where the objective sees the greatest load alone.
  void weigh_total(double weight);
  // Whether the greatest load counts.
  bool sees_greatest() const { return sees_greatest_; }

 private:
  const Problem& problem_;
  Team& team_;
  bool sees_greatest_;
  bool sees_total_;
  double tie_;                  // weight of the usage where the objective does not see it
  int most_[3] = {-1, -1, -1};  // the robots that do most, the first first
};

}  // namespace muster
