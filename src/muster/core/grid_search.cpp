// Hart, Nilsson, Raphael 1968 (A*); Dijkstra 1959; Nash, Daniel, Koenig, Felner 2007 (Theta*), algorithm of the same
// names.
#include "grid_search.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>

#include "heap.hpp"

namespace muster {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Step {
  int dx, dy;
  double length;
};
constexpr std::array<Step, 8> kSteps{{{1, 0, 1.0},
                                      {0, 1, 1.0},
                                      {-1, 0, 1.0},
                                      {0, -1, 1.0},
                                      {1, 1, std::numbers::sqrt2},
                                      {-1, 1, std::numbers::sqrt2},
                                      {-1, -1, std::numbers::sqrt2},
                                      {1, -1, std::numbers::sqrt2}}};

struct Open {
  double key;  // f
  int cell;
};

class Searcher {
 public:
  Searcher(const GridMap& map, Point start, Point goal, GridSearch how)
      : map_(map), goal_(goal), how_(how), ends_(map.cells_at(GridMap::snap(goal))) {
    const auto cells = static_cast<std::size_t>(map.rows()) * map.columns();
    state_.assign(cells, kUnseen);
    found_ = std::make_unique_for_overwrite<Found[]>(cells);
    for (const int cell : map.cells_at(GridMap::snap(start)))
      reach(cell, x(cell), y(cell), distance(start, centre(cell)), cell);
  }

  std::vector<int> run() {
    int last = -1;
    double best = kFar;
    while (!open_.empty() && open_.top().key < best) {
      const int cell = open_.pop().cell;
      if (state_[cell] == kClosed) continue;
      state_[cell] = kClosed;
      if (std::find(ends_.begin(), ends_.end(), cell) != ends_.end()) {
        const double whole = found_[cell].g + distance(centre(cell), goal_);
        if (whole < best) best = whole, last = cell;
      }
      expand(cell);
    }
    return last < 0 ? std::vector<int>{} : way_to(last);
  }

 private:
  enum State : char { kUnseen, kOpen, kClosed };
  struct Found {
    double g;
    int parent;
  };

  int x(int cell) const { return cell % map_.columns(); }
  int y(int cell) const { return cell / map_.columns(); }
  Point centre(int cell) const { return {x(cell) + 0.5, y(cell) + 0.5}; }
  Lattice lattice(int cell) const { return GridMap::centre(x(cell), y(cell)); }

  void expand(int cell) {
    const int column = x(cell), row = y(cell);
    for (const Step& step : kSteps) {
      const int to_column = column + step.dx, to_row = row + step.dy;
      if (map_.blocked(to_column, to_row)) continue;
      const bool diagonal = step.dx != 0 && step.dy != 0;
      if (diagonal && (map_.blocked(to_column, row) || map_.blocked(column, to_row))) continue;
      const int next = cell + step.dy * map_.columns() + step.dx;
      if (state_[next] == kClosed) continue;
      // Theta*: path 2 goes straight from the parent of the cell where that sees the next one; else path 1 goes through
      // it.
      const int from = found_[cell].parent;
      if (how_.any_angle && from != cell && map_.sees(lattice(from), lattice(next))) {
        reach(next, to_column, to_row, found_[from].g + distance(centre(from), centre(next)), from);
      } else {
        reach(next, to_column, to_row, found_[cell].g + step.length, cell);
      }
    }
  }

  void reach(int cell, int column, int row, double g, int from) {
    if (state_[cell] != kUnseen && found_[cell].g <= g) return;
    state_[cell] = kOpen;
    found_[cell] = {g, from};
    open_.push({g + estimate(column, row), cell});
  }

  // Theta*: the straight distance. Else the octile distance to the nearest of the last cells, and on to the goal.
  double estimate(int column, int row) const {
    if (!how_.heuristic) return 0.0;
    if (how_.any_angle) return distance({column + 0.5, row + 0.5}, goal_);
    double least = kFar;
    for (const int end : ends_) {
      const int dx = std::abs(column - x(end)), dy = std::abs(row - y(end));
      const double octile = std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy);
      least = std::min(least, octile + distance(centre(end), goal_));
    }
    return least;
  }

  std::vector<int> way_to(int cell) const {
    std::vector<int> way{cell};
    while (found_[cell].parent != cell) way.push_back(cell = found_[cell].parent);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const GridMap& map_;
  Point goal_;
  GridSearch how_;
  std::vector<int> ends_;
  std::vector<char> state_;
  std::unique_ptr<Found[]> found_;
  Heap<Open> open_;
};

}  // namespace

std::vector<int> search_grid(const GridMap& map, Point start, Point goal, GridSearch how) {
  return Searcher(map, start, goal, how).run();
}

}  // namespace muster
