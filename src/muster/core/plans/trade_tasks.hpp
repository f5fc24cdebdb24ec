// Where tasks are left out: one of them is put in, or in the place of another.
#pragma once

#include "plans/move.hpp"

namespace muster {

class TradeTasks : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely(); }
  bool improve(int task) override;

 private:
  bool put(int absent, int after);
  bool replace(int task, int absent);
};

}  // namespace muster
