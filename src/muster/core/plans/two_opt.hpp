// 2-opt [croes1958]: a part of a route is turned round.
#pragma once

#include "plans/move.hpp"

namespace muster {

class TwoOpt : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely() && problem.is_symmetric(); }
  bool improve(int task) override;

 private:
  bool turn(int robot, int first, int last);
};

}  // namespace muster
