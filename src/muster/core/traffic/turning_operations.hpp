// Operations: sequences of a few actions of a robot with a heading, as EPIBT chooses among them [yukhnevich2025].
#pragma once

#include <array>
#include <vector>

#include "traffic/turning_grid.hpp"

namespace muster {

// How many steps an operation has.
constexpr int kOperationSteps = 4;
// The states of a robot after each of the steps of an operation.
using Operation = std::array<int, kOperationSteps>;

// All operations that differ in the cells at some step, or in the heading at the end. Of those that do not, the one
// that turns first counts.
class TurningOperations {
 public:
  TurningOperations();

  // Calls visit(operation) for each operation that a robot can carry out from a state on a grid.
  template <class Visit>
  void for_each(const TurningGrid& grid, int state, Visit visit) const {
    std::array<int, kOperationSteps + 1> states{state};
    Operation operation;
    for (std::size_t k = 0; k < nodes_.size();) {
      const Node& node = nodes_[k];
      const int next = apply(grid, node.action, states[node.depth - 1]);
      if (next == TurningGrid::kNone) {
        k = node.beside;
        continue;
      }
      states[node.depth] = operation[node.depth - 1] = next;
      if (node.depth == kOperationSteps) visit(operation);
      ++k;
    }
  }

  // The action between two states, as the league writes it: F, R, C or W.
  static char action(int from, int to) {
    if (TurningGrid::vertex_of(from) != TurningGrid::vertex_of(to)) return 'F';
    return from == to ? 'W' : to == TurningGrid::turned(from, 1) ? 'R' : 'C';
  }

 private:
  // A tree of actions, in depth.
  struct Node {
    char action;
    int depth;
    std::size_t beside;  // the next node that is not below this one
  };

  static int apply(const TurningGrid& grid, char action, int state) {
    switch (action) {
      case 'F':
        return grid.ahead(state);
      case 'R':
        return TurningGrid::turned(state, 1);
      case 'C':
        return TurningGrid::turned(state, 3);
      default:
        return state;
    }
  }

  std::vector<Node> nodes_;
};

}  // namespace muster
