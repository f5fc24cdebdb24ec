// Local search: routes are improved around the tasks where they changed, until no move improves them any more.
#pragma once

#include <memory>
#include <vector>

#include "plans/move.hpp"

namespace muster {

class LocalSearch {
 public:
  LocalSearch(const Problem& problem, const Neighbours& neighbours, Team& team, TeamCost& cost);
  LocalSearch(const LocalSearch&) = delete;
  LocalSearch& operator=(const LocalSearch&) = delete;

  // Whether there is a move for these rules.
  bool applies() const { return !moves_.empty(); }
  // What a unit of weight left out counts as cost.
  void weigh(double penalty) { around_.penalty = penalty; }
  // Around this place something has changed.
  void wake(int place) { around_.wake(place); }
  // Improves the routes around all places that are awake; they are asleep then.
  void improve();

 private:
  Surroundings around_;
  std::vector<std::unique_ptr<Move>> moves_;
};

// Routes after local search alone, from every task, with no less weight of tasks.
Routes improved(const Problem& problem, const Routes& routes);

}  // namespace muster
