#include "traffic/traffic_guidance.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

constexpr int kInfinite = std::numeric_limits<int>::max();

}  // namespace

TrafficGuidance::TrafficGuidance(std::shared_ptr<const DirectedGraph> graph, std::vector<int> starts,
                                 std::vector<int> goals, std::uint64_t seed)
    : graph_(std::move(graph)),
      starts_(std::move(starts)),
      distances_(std::make_shared<GoalDistances>(graph_, std::move(goals))),
      order_(starts_.size()),
      opposite_(graph_->edges()),
      taken_(graph_->edges(), 0),
      visited_(graph_->size(), 0),
      costs_(graph_->size(), kInfinite),
      reached_by_(graph_->size(), -1) {
  if (starts_.size() != distances_->goals().size()) {
    throw std::invalid_argument("there must be as many goals as starts");
  }
  for (const int start : starts_) {
    if (start < 0 || start >= graph_->size()) throw std::invalid_argument("a start is no vertex of the graph");
  }
  for (int e = 0; e < graph_->edges(); ++e) opposite_[e] = graph_->edge(graph_->head(e), graph_->tail(e));
  std::iota(order_.begin(), order_.end(), 0);
  Random random(seed);
  for (std::size_t k = order_.size(); k > 1; --k) {
    std::swap(order_[k - 1], order_[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
  }
}

void TrafficGuidance::advance(int steps) {
  for (; steps > 0 && !finished(); --steps) {
    const int robot = order_[done_ % order_.size()];
    if (done_ < order_.size()) {
      const int way = distances_->to_goal(robot, starts_[robot]);
      connected_ = way < DirectedGraph::kNoWay;
      if (!connected_) return;
      least_sum_ += way;
      choose_way(robot);
    } else {
      if (guided_ == nullptr) {
        std::vector<int> costs(taken_.size());
        for (int e = 0; e < graph_->edges(); ++e) costs[e] = cost(e);
        guided_ = std::make_shared<GoalDistances>(graph_, distances_->goals(), std::move(costs));
      }
      guided_->to_goal(robot, starts_[robot]);
    }
    ++done_;
  }
}

int TrafficGuidance::cost(int edge) const {
  const int against = opposite_[edge] < 0 ? 0 : taken_[opposite_[edge]];
  return kStep + kOpposite * against + kSameVertex * visited_[graph_->head(edge)];
}

// A* with the number of steps as heuristic; counts the robot on its edges.
void TrafficGuidance::choose_way(int robot) {
  const int start = starts_[robot], goal = distances_->goal(robot);
  for (const int vertex : touched_) costs_[vertex] = kInfinite;
  touched_ = {start};
  open_.clear();
  costs_[start] = 0;
  reached_by_[start] = -1;
  open_.push({kStep * distances_->to_goal(robot, start), start, 0});
  while (!open_.empty()) {
    const Reached from = open_.pop();
    if (from.vertex == goal) break;
    if (from.cost != costs_[from.vertex]) continue;
    for (int e = graph_->begin(from.vertex); e < graph_->end(from.vertex); ++e) {
      const int to = graph_->head(e), sum = from.cost + cost(e), steps = distances_->to_goal(robot, to);
      if (sum >= costs_[to] || steps == DirectedGraph::kNoWay) continue;
      if (costs_[to] == kInfinite) touched_.push_back(to);
      costs_[to] = sum;
      reached_by_[to] = e;
      open_.push({sum + kStep * steps, to, sum});
    }
  }
  for (int at = goal; at != start; at = graph_->tail(reached_by_[at])) {
    ++taken_[reached_by_[at]];
    ++visited_[at];
  }
}

}  // namespace muster
