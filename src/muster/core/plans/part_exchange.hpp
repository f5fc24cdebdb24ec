// Or-3opt: two parts of a route that follow each other change places, neither turned round.
#pragma once

#include "plans/move.hpp"

namespace muster {

class PartExchange : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely(); }
  bool improve(int task) override;

 private:
  bool reached_anew(int robot, int task);
  bool left_anew(int robot, int task);
  bool exchange(int robot, int first, int second, int last);
};

}  // namespace muster
