#include "traffic/turning_grid.hpp"

#include <cstdlib>
#include <stdexcept>

namespace muster {

TurningGrid::TurningGrid(int rows, int columns, const std::vector<bool>& blocked) : columns_(columns) {
  if (rows < 1 || columns < 1 || static_cast<long>(blocked.size()) != static_cast<long>(rows) * columns) {
    throw std::invalid_argument("blocked: expected an entry for each cell of the grid");
  }
  vertices_.assign(blocked.size(), kNone);
  for (int cell = 0; cell < static_cast<int>(blocked.size()); ++cell) {
    if (blocked[cell]) continue;
    vertices_[cell] = size();
    cells_.push_back(cell);
  }
  connect(rows);
  number_parts();
}

void TurningGrid::connect(int rows) {
  ahead_.assign(4 * cells_.size(), kNone);
  for (int v = 0; v < size(); ++v) {
    const int row = cells_[v] / columns_, column = cells_[v] % columns_;
    const bool inside[] = {column + 1 < columns_, row + 1 < rows, column > 0, row > 0};
    const int offsets[] = {1, columns_, -1, -columns_};
    for (int heading = 0; heading < 4; ++heading) {
      const int there = inside[heading] ? vertices_[cells_[v] + offsets[heading]] : kNone;
      if (there != kNone) ahead_[4 * v + heading] = 4 * there + heading;
    }
  }
}

void TurningGrid::number_parts() {
  parts_.assign(cells_.size(), kNone);
  std::vector<int> open;
  for (int first = 0; first < size(); ++first) {
    if (parts_[first] != kNone) continue;
    parts_[first] = first;
    open.assign(1, first);
    while (!open.empty()) {
      const int v = open.back();
      open.pop_back();
      for (int heading = 0; heading < 4; ++heading) {
        const int state = ahead_[4 * v + heading];
        if (state == kNone || parts_[vertex_of(state)] != kNone) continue;
        parts_[vertex_of(state)] = first;
        open.push_back(vertex_of(state));
      }
    }
  }
}

int TurningGrid::manhattan(int a, int b) const {
  return std::abs(cells_[a] / columns_ - cells_[b] / columns_) + std::abs(cells_[a] % columns_ - cells_[b] % columns_);
}

}  // namespace muster
