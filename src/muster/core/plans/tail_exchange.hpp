// 2-opt* [potvin1995]: two routes exchange all that they do behind a place.
#pragma once

#include "plans/move.hpp"

namespace muster {

class TailExchange : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely() && problem.robots() > 1; }
  bool improve(int task) override;

 private:
  bool exchange(int place, int other);
};

}  // namespace muster
