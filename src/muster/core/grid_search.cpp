// Hart, Nilsson, Raphael 1968 (A*); Dijkstra 1959; Nash, Daniel, Koenig, Felner 2007 (Theta*), algorithm of the same names.
#include "grid_search.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numbers>
#include <queue>

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
  double f, g;
  int cell;
  // The least f first; of equal ones the furthest on.
  friend bool operator<(const Open& a, const Open& b) { return a.f > b.f || (a.f == b.f && a.g < b.g); }
};

class Searcher {
 public:
  Searcher(const GridMap& map, Point start, Point goal, GridSearch how)
      : map_(map), goal_(goal), how_(how), ends_(map.cells_at(GridMap::snap(goal))) {
    const auto cells = static_cast<std::size_t>(map.rows()) * map.columns();
    state_.assign(cells, kUnseen);
    g_ = std::make_unique_for_overwrite<double[]>(cells);
    parent_ = std::make_unique_for_overwrite<int[]>(cells);
    for (const int cell : map.cells_at(GridMap::snap(start))) reach(cell, distance(start, centre(cell)), cell);
  }

  std::vector<int> run() {
    int last = -1;
    double best = kFar;
    while (!open_.empty() && open_.top().f < best) {
      const Open top = open_.top();
      open_.pop();
      if (state_[top.cell] == kClosed) continue;
      state_[top.cell] = kClosed;
      if (std::find(ends_.begin(), ends_.end(), top.cell) != ends_.end()) {
        const double whole = top.g + distance(centre(top.cell), goal_);
        if (whole < best) best = whole, last = top.cell;
      }
      expand(top.cell);
    }
    return last < 0 ? std::vector<int>{} : way_to(last);
  }

 private:
  enum State : char { kUnseen, kOpen, kClosed };

  Point centre(int cell) const { return {cell % map_.columns() + 0.5, cell / map_.columns() + 0.5}; }

  void expand(int cell) {
    const int x = cell % map_.columns(), y = cell / map_.columns();
    for (const Step& step : kSteps) {
      if (map_.blocked(x + step.dx, y + step.dy)) continue;
      const bool cuts_corner = step.dx != 0 && step.dy != 0 && (map_.blocked(x + step.dx, y) || map_.blocked(x, y + step.dy));
      if (cuts_corner) continue;
      const int next = cell + step.dy * map_.columns() + step.dx;
      if (state_[next] != kClosed) update(cell, next, step.length);
    }
  }

  // Theta*: path 2 goes straight from the parent of the cell where that sees the next cell; else path 1 goes through it.
  void update(int cell, int next, double length) {
    const int from = parent_[cell];
    if (how_.any_angle && from != cell && map_.sees(lattice(from), lattice(next))) {
      reach(next, g_[from] + distance(centre(from), centre(next)), from);
    } else {
      reach(next, g_[cell] + length, cell);
    }
  }

  void reach(int cell, double g, int from) {
    if (state_[cell] != kUnseen && g_[cell] <= g) return;
    state_[cell] = kOpen;
    g_[cell] = g;
    parent_[cell] = from;
    open_.push({g + estimate(cell), g, cell});
  }

  // Theta*: the straight distance. Else the octile distance to the nearest of the last cells, and on to the goal.
  double estimate(int cell) const {
    if (!how_.heuristic) return 0.0;
    if (how_.any_angle) return distance(centre(cell), goal_);
    double least = kFar;
    for (const int end : ends_) least = std::min(least, octile(cell, end) + distance(centre(end), goal_));
    return least;
  }

  double octile(int a, int b) const {
    const int dx = std::abs(a % map_.columns() - b % map_.columns()), dy = std::abs(a / map_.columns() - b / map_.columns());
    return std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy);
  }

  Lattice lattice(int cell) const { return GridMap::centre(cell % map_.columns(), cell / map_.columns()); }

  std::vector<int> way_to(int cell) const {
    std::vector<int> way{cell};
    while (parent_[cell] != cell) way.push_back(cell = parent_[cell]);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const GridMap& map_;
  Point goal_;
  GridSearch how_;
  std::vector<int> ends_;
  std::vector<char> state_;
  std::unique_ptr<double[]> g_;
  std::unique_ptr<int[]> parent_;
  std::priority_queue<Open> open_;
};

}  // namespace

std::vector<int> search_grid(const GridMap& map, Point start, Point goal, GridSearch how) {
  return Searcher(map, start, goal, how).run();
}

}  // namespace muster
