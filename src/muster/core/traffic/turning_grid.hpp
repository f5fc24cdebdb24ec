// A grid of cells for robots with a heading: a step goes forward, turns by 90 degrees, or waits.
#pragma once

#include <vector>

namespace muster {

// A state is 4 * vertex + heading; headings are 0 east, 1 south, 2 west and 3 north, so that + 1 is clockwise. Vertices
// are the free cells in the order of their rows.
class TurningGrid {
 public:
  // `blocked` has rows * columns entries. Throws std::invalid_argument where it has not.
  TurningGrid(int rows, int columns, const std::vector<bool>& blocked);

  static constexpr int kNone = -1;
  static int vertex_of(int state) { return state >> 2; }
  static int turned(int state, int clockwise) { return (state & ~3) | ((state + clockwise) & 3); }

  int size() const { return static_cast<int>(cells_.size()); }
  // The state after a step forward; kNone where that is blocked.
  int ahead(int state) const { return ahead_[state]; }
  // kNone where a cell is blocked.
  int vertex(int cell) const { return vertices_[cell]; }
  int columns() const { return columns_; }
  int cell(int vertex) const { return cells_[vertex]; }
  // Vertices are connected if they have the same part.
  int part(int vertex) const { return parts_[vertex]; }
  // Number of steps between two vertices if nothing were blocked and turns took no time.
  int manhattan(int a, int b) const;

 private:
  void connect(int rows);
  void number_parts();

  int columns_;
  std::vector<int> vertices_, cells_, ahead_, parts_;
};

}  // namespace muster
