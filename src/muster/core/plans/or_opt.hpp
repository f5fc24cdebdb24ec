// Or-opt [or1976]: up to three tasks in a row go elsewhere, in this route or in another, one way round or the other.
#pragma once

#include "plans/move.hpp"

namespace muster {

class OrOpt : public Move {
 public:
  using Move::Move;

  static bool supports(const Problem& problem) { return problem.moves_freely(); }
  bool improve(int task) override;

 private:
  static constexpr int kLongest = 3;

  // Tasks in a row, taken out: what is saved, and what they cost among themselves.
  struct Row {
    int robot, first, last, length;
    double saved, inside;
  };

  bool improve(int task, const Row& row);
  bool put(const Row& row, int after, bool turned);
  bool gains(const Row& row, int robot, bool turned, double added) const;
  bool contains(const Row& row, int place) const;
  double inside(const Row& row, int robot, bool turned) const;
  bool allowed(const Row& row, int robot) const;
};

}  // namespace muster
