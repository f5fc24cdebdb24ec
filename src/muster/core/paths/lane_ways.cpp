#include "paths/lane_ways.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "heap.hpp"
#include "infinity.hpp"

namespace muster {

namespace {

// Of ways that are as quick the shortest is taken: a metre counts as so many seconds beside those that it takes.
constexpr double kSecondsPerMetre = 1e-6;

}  // namespace

// Dijkstra's algorithm over arcs, as a bend depends on two of them. Where bends cost nothing, the first arc that comes
// to a point is followed alone.
struct LaneWays::Search {
  std::vector<Label> labels;  // of arcs
  std::vector<char> settled;  // arcs
  std::vector<int> arrived;   // of each point the first arc that was settled of those that lead to it; -1: none
  Heap<Item> queue;

  Search(std::size_t arcs, std::size_t points)
      : labels(arcs, Label{kNever, kNever, kFar, -1}), settled(arcs), arrived(points, -1) {}
};

LaneWays::LaneWays(std::vector<Point> points, std::vector<std::pair<int, int>> ends, std::vector<double> seconds,
                   double turn, double stop)
    : points_(std::move(points)), seconds_(std::move(seconds)), first_(points_.size() + 1), turn_(turn), stop_(stop) {
  if (ends.size() != seconds_.size() || !(turn >= 0.0) || !(stop >= 0.0))
    throw std::invalid_argument("arcs, their times and those of bends do not fit");
  for (const auto& [tail, head] : ends) {
    if (std::min(tail, head) < 0 || std::max(tail, head) >= this->points())
      throw std::invalid_argument("an arc leads to no point");
    const Point from = points_[tail], to = points_[head];
    tails_.push_back(tail);
    heads_.push_back(head);
    metres_.push_back(distance(from, to));
    directions_.push_back(std::atan2(to.y - from.y, to.x - from.x));
    ++first_[tail + 1];
  }
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  leaving_.resize(tails_.size());
  std::vector<int> at(first_.begin(), first_.end() - 1);
  for (int arc = 0; arc < static_cast<int>(tails_.size()); ++arc) leaving_[at[tails_[arc]]++] = arc;
}

double LaneWays::bend(int arc, int next) const {
  if (turn_ == 0.0 && stop_ == 0.0) return 0.0;
  double by = std::abs(directions_[next] - directions_[arc]);
  by = std::min(by, 2.0 * std::numbers::pi - by) / (0.5 * std::numbers::pi);
  return by * turn_ + std::min(1.0, by) * stop_;
}

void LaneWays::settle(Search& search, int start, std::vector<int> goals) const {
  std::ranges::sort(goals);
  goals.erase(std::ranges::unique(goals).begin(), goals.end());
  std::erase_if(goals, [&](int goal) { return goal < 0 || goal == start; });
  std::size_t left = goals.size();
  const bool with_bends = turn_ > 0.0 || stop_ > 0.0;
  const auto reach = [&](int arc, double seconds, double metres, int parent) {
    const Label label{seconds + seconds_[arc] + kSecondsPerMetre * (metres + metres_[arc]), seconds + seconds_[arc],
                      metres + metres_[arc], parent};
    if (!(label.key < search.labels[arc].key)) return;
    search.labels[arc] = label;
    search.queue.push({label.key, arc});
  };
  for (int k = first_[start]; k < first_[start + 1]; ++k) reach(leaving_[k], 0.0, 0.0, -1);
  while (left > 0 && !search.queue.empty()) {
    const int arc = search.queue.pop().arc;
    if (search.settled[arc]) continue;
    search.settled[arc] = 1;
    const int here = heads_[arc];
    const bool is_first = search.arrived[here] < 0;
    if (is_first) {
      search.arrived[here] = arc;
      if (std::ranges::binary_search(goals, here)) --left;
    }
    if (!is_first && !with_bends) continue;
    for (int k = first_[here]; k < first_[here + 1]; ++k) {
      const int next = leaving_[k];
      if (!search.settled[next])
        reach(next, search.labels[arc].seconds + bend(arc, next), search.labels[arc].metres, arc);
    }
  }
}

std::vector<LaneWays::Length> LaneWays::lengths(int start, const std::vector<int>& goals) const {
  std::vector<Length> found(goals.size(), {kFar, kNever});
  if (start < 0) return found;
  Search search(tails_.size(), points_.size());
  settle(search, start, goals);
  for (std::size_t k = 0; k < goals.size(); ++k) {
    if (goals[k] == start) {
      found[k] = {0.0, 0.0};
    } else if (goals[k] >= 0 && search.arrived[goals[k]] >= 0) {
      const Label& label = search.labels[search.arrived[goals[k]]];
      found[k] = {label.metres, label.seconds};
    }
  }
  return found;
}

std::vector<int> LaneWays::way(int start, int goal) const {
  if (start < 0 || goal < 0) return {};
  if (start == goal) return {start};
  Search search(tails_.size(), points_.size());
  settle(search, start, {goal});
  std::vector<int> found;
  for (int arc = search.arrived[goal]; arc >= 0; arc = search.labels[arc].parent) found.push_back(heads_[arc]);
  if (!found.empty()) found.push_back(start);
  std::ranges::reverse(found);
  return found;
}

}  // namespace muster
