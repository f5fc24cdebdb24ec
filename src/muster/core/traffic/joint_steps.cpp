#include "traffic/joint_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace muster {

JointSteps::JointSteps(const TrafficGuidance& guidance, int samples, std::uint64_t seed)
    : distances_(guidance.distances()),
      guided_(guidance.guided() == nullptr ? guidance.distances() : guidance.guided()),  // null without robots
      starts_(guidance.starts()),
      samples_(samples),
      pibt_(distances_, seed) {
  if (!guidance.finished() || !guidance.connected()) throw std::invalid_argument("the guidance is not finished");
  constexpr double kMore = 1.2;  // than its shortest way takes
  constexpr int kSteps = 20;
  int longest = 0;
  for (int i = 0; i < pibt_.robots(); ++i) {
    guided_until_.push_back(static_cast<int>(kMore * distances_->to_goal(i, starts_[i])) + kSteps);
    longest = std::max(longest, guided_until_.back());
  }
  guided_calls_ = 3 * longest;
}

// Who has the longer way goes first, by less than what a step without arrival adds.
JointSteps::Memo JointSteps::memo() const {
  Memo memo;
  for (int i = 0; i < pibt_.robots(); ++i) {
    memo.priorities.push_back(static_cast<double>(distances_->to_goal(i, starts_[i])) /
                              (distances_->graph().size() + 1));
  }
  return memo;
}

double JointSteps::cost(const Configuration& from, const Configuration& to) const {
  int moved = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const int goal = distances_->goals()[i];
    moved += from[i] != goal || to[i] != goal;
  }
  return moved;
}

double JointSteps::least_cost(const Configuration& places) const {
  double sum = 0;
  for (int i = 0; i < pibt_.robots(); ++i) sum += distances_->to_goal(i, places[i]);
  return sum;
}

void JointSteps::order(const Memo& memo, std::vector<int>& robots) const {
  const auto& priorities = memo.priorities;
  robots.resize(priorities.size());
  std::iota(robots.begin(), robots.end(), 0);
  std::stable_sort(robots.begin(), robots.end(), [&](int i, int j) { return priorities[i] > priorities[j]; });
}

void JointSteps::moves(const Configuration& places, int robot, std::vector<int>& found) const {
  const auto neighbours = distances_->graph().neighbours(places[robot]);
  found.assign(neighbours.begin(), neighbours.end());
  found.push_back(places[robot]);
}

bool JointSteps::next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
                      Memo& grown) {
  order(memo, order_);
  const bool guided = ++calls_ <= guided_calls_;
  for (int i = 0; i < pibt_.robots(); ++i) {
    pibt_.follow(i, guided && memo.step < guided_until_[i] ? *guided_ : *distances_);
  }
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
  grown = memo;
  ++grown.step;
  for (std::size_t i = 0; i < to.size(); ++i) {
    double& priority = grown.priorities[i];
    priority = to[i] == distances_->goals()[i] ? priority - std::floor(priority) : priority + 1;
  }
  return true;
}

}  // namespace muster
