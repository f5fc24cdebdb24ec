// Two tasks change places, in one route or between two.
#pragma once

#include "plans/move.hpp"

namespace muster {

class SwapTasks : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely(); }
  bool improve(int task) override;

 private:
  bool swap(int task, int other);
};

}  // namespace muster
