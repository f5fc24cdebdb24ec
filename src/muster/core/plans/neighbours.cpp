#include "plans/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace muster {

namespace {

// Up to this many tasks each is compared with each; beyond it tasks lie on a grid.
constexpr int kMostCompared = 1000;

// The nearest of candidates (distance, index), appended as one row.
void append_nearest(std::vector<std::pair<double, int>>& candidates, int count, Rows& rows) {
  const auto kept = std::min<std::size_t>(count, candidates.size());
  std::ranges::partial_sort(candidates, candidates.begin() + static_cast<std::ptrdiff_t>(kept));
  for (std::size_t k = 0; k < kept; ++k) rows.values.push_back(candidates[k].second);
  rows.first.push_back(static_cast<int>(rows.values.size()));
}

}  // namespace

Neighbours::Neighbours(const Problem& problem, int tasks, int robots) {
  if (problem.tasks() <= kMostCompared || problem.has_table()) {
    by_comparison(problem, tasks);
  } else {
    by_grid(problem, tasks);
  }
  std::vector<std::pair<double, int>> candidates;
  for (int task = 0; task < problem.tasks(); ++task) {
    candidates.clear();
    for (const int robot : problem.robots_allowed(task)) {
      candidates.emplace_back(problem.distance(problem.travel_class(robot), problem.start(robot), task), robot);
    }
    append_nearest(candidates, robots, robots_);
  }
}

double Neighbours::distance(const Problem& problem, int a, int b) const {
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < problem.classes(); ++c) {
    least = std::min({least, problem.distance(c, a, b), problem.distance(c, b, a)});
  }
  return least;
}

void Neighbours::by_comparison(const Problem& problem, int count) {
  std::vector<std::pair<double, int>> candidates;
  for (int task = 0; task < problem.tasks(); ++task) {
    candidates.clear();
    for (int other = 0; other < problem.tasks(); ++other) {
      if (other != task) candidates.emplace_back(distance(problem, task, other), other);
    }
    append_nearest(candidates, count, tasks_);
  }
}

// Cells of a few tasks each; rings of cells around a task's own are searched until nothing nearer can follow.
void Neighbours::by_grid(const Problem& problem, int count) {
  const int n = problem.tasks();
  double low[2], high[2];
  for (int axis = 0; axis < 2; ++axis) {
    low[axis] = high[axis] = problem.entry(0, axis);
    for (int task = 1; task < n; ++task) {
      low[axis] = std::min(low[axis], problem.entry(task, axis));
      high[axis] = std::max(high[axis], problem.entry(task, axis));
    }
  }
  const double width = std::max(high[0] - low[0], 1e-9), height = std::max(high[1] - low[1], 1e-9);
  const double side = std::max(std::sqrt(width * height * 4.0 / n), std::max(width, height) / 4096.0);
  const int columns = 1 + static_cast<int>(width / side), rows = 1 + static_cast<int>(height / side);
  const auto column = [&](int task) { return static_cast<int>((problem.entry(task, 0) - low[0]) / side); };
  const auto row = [&](int task) { return static_cast<int>((problem.entry(task, 1) - low[1]) / side); };
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(columns) * rows);
  for (int task = 0; task < n; ++task)
    cells[static_cast<std::size_t>(row(task)) * columns + column(task)].push_back(task);
  std::vector<std::pair<double, int>> candidates;
  for (int task = 0; task < n; ++task) {
    candidates.clear();
    const int x = column(task), y = row(task);
    int nearer = 0;
    for (int ring = 0; ring <= std::max(columns, rows); ++ring) {
      for (int cy = std::max(0, y - ring); cy <= std::min(rows - 1, y + ring); ++cy) {
        const bool whole_row = cy == y - ring || cy == y + ring;
        for (int cx = x - ring; cx <= x + ring; cx += whole_row || ring == 0 ? 1 : 2 * ring) {
          if (cx < 0 || cx >= columns) continue;
          for (const int other : cells[static_cast<std::size_t>(cy) * columns + cx]) {
            if (other != task) candidates.emplace_back(distance(problem, task, other), other);
          }
        }
      }
      nearer =
          static_cast<int>(std::ranges::count_if(candidates, [&](const auto& c) { return c.first <= ring * side; }));
      if (nearer >= count) break;
    }
    append_nearest(candidates, count, tasks_);
  }
}

}  // namespace muster
