#include "traffic/joint_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

namespace {

Configuration checked(const DirectedGraph& graph, Configuration places) {
  for (const int place : places) {
    if (place < 0 || place >= graph.size()) throw std::invalid_argument("a place is no vertex of the graph");
  }
  return places;
}

}  // namespace

JointSteps::JointSteps(std::shared_ptr<const DirectedGraph> graph, Configuration starts, std::vector<int> goals,
                       int samples, std::uint64_t seed)
    : graph_(std::move(graph)),
      starts_(checked(*graph_, std::move(starts))),
      goals_(checked(*graph_, std::move(goals))),
      samples_(samples),
      pibt_(*graph_, goals_, seed) {
  if (starts_.size() != goals_.size()) throw std::invalid_argument("there must be as many goals as starts");
}

// Who has the longer way goes first, by less than what a step without arrival adds.
JointSteps::Memo JointSteps::memo() const {
  Memo priorities;
  for (int i = 0; i < pibt_.robots(); ++i) {
    priorities.push_back(static_cast<double>(pibt_.distance(i, starts_[i])) / (graph_->size() + 1));
  }
  return priorities;
}

double JointSteps::cost(const Configuration& from, const Configuration& to) const {
  int moved = 0;
  for (std::size_t i = 0; i < from.size(); ++i) moved += from[i] != goals_[i] || to[i] != goals_[i];
  return moved;
}

double JointSteps::least_cost(const Configuration& places) const {
  double sum = 0;
  for (int i = 0; i < pibt_.robots(); ++i) sum += pibt_.distance(i, places[i]);
  return sum;
}

void JointSteps::order(const Memo& priorities, std::vector<int>& robots) const {
  robots.resize(priorities.size());
  std::iota(robots.begin(), robots.end(), 0);
  std::stable_sort(robots.begin(), robots.end(), [&](int i, int j) { return priorities[i] > priorities[j]; });
}

void JointSteps::moves(const Configuration& places, int robot, std::vector<int>& found) const {
  const auto neighbours = graph_->neighbours(places[robot]);
  found.assign(neighbours.begin(), neighbours.end());
  found.push_back(places[robot]);
}

bool JointSteps::next(const Configuration& from, const Memo& priorities, std::span<const Constraint> said,
                      Configuration& to, Memo& grown) {
  order(priorities, order_);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < samples_; ++k) {
    sample_.assign(from.size(), kUndecided);
    for (const auto [robot, where] : said) sample_[robot] = where;
    if (!pibt_.step(from, sample_, order_)) continue;
    const double cost = samples_ == 1 ? 0 : this->cost(from, sample_) + least_cost(sample_);
    if (cost < least) {
      least = cost;
      to = sample_;
    }
  }
  if (to.empty() && !from.empty()) return false;
  grown = priorities;
  for (std::size_t i = 0; i < to.size(); ++i) {
    grown[i] = to[i] == goals_[i] ? grown[i] - std::floor(grown[i]) : grown[i] + 1;
  }
  return true;
}

bool JointSteps::connected() const {
  for (int i = 0; i < pibt_.robots(); ++i) {
    if (pibt_.distance(i, starts_[i]) == DirectedGraph::kNoWay) return false;
  }
  return true;
}

}  // namespace muster
