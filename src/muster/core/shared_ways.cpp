#include "shared_ways.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace muster {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kGroup = 4;  // travellers that are planned anew at a time

}  // namespace

SharedWays::SharedWays(SafeIntervals& roadmap, std::vector<Traveller> travellers, std::vector<int> order,
                       std::uint64_t seed)
    : roadmap_(roadmap), travellers_(std::move(travellers)), order_(std::move(order)), random_(seed) {
  const int n = static_cast<int>(travellers_.size());
  roadmap_.clear();
  ways_.assign(n, {{}, 0.0, kNever});
  for (int k = 0; k < n; ++k)
    if (travellers_[k].fixed) roadmap_.reserve(k, travellers_[k], ways_[k]);
  for (Traveller& who : travellers_) {
    const bool goes = !who.fixed && !who.stops.empty();
    alone_.push_back(who.fixed ? Way{{}, 0.0, kNever} : alone(who));
    cut_off_.push_back(goes && who.stops.empty());
  }
  std::ranges::copy_if(order_, std::back_inserter(free_), [&](int k) { return !travellers_[k].fixed; });
  plan(free_);
}

// Stops to which no way leads past those who never leave, and those after them, are left out.
Way SharedWays::alone(Traveller& who) const {
  Way found = roadmap_.way(who);
  while (!who.stops.empty() && found.end == kNever) {
    who.stops.pop_back();
    who.stays = false;
    found = roadmap_.way(who);
  }
  return found;
}

void SharedWays::improve(int tries, int lost) {
  for (int sought = 0; std::ranges::any_of(free_, [&](int k) { return ways_[k].end > alone_[k].end; });) {
    const int most = (cost().first > 0 ? lost : tries) * static_cast<int>(free_.size());
    if (sought >= most) return;
    const std::vector<int> group = neighbours();
    sought += static_cast<int>(group.size());
    replan(group);
  }
}

void SharedWays::plan(std::span<const int> group) {
  for (const int k : group) roadmap_.reserve_start(k, travellers_[k]);
  for (const int k : group) {
    roadmap_.release_start(k, travellers_[k]);
    ways_[k] = roadmap_.way(travellers_[k]);
    roadmap_.reserve(k, travellers_[k], ways_[k]);
  }
}

void SharedWays::replan(const std::vector<int>& group) {
  const Cost before = cost();
  std::vector<Way> kept;
  for (const int k : group) {
    roadmap_.release(k, travellers_[k], ways_[k]);
    kept.push_back(ways_[k]);
  }
  plan(group);
  if (cost() < before) {
    const auto planned_anew = [&](int k) { return std::ranges::find(group, k) != group.end(); };
    const auto last = std::ranges::stable_partition(order_, [&](int k) { return !planned_anew(k); });
    std::ranges::copy(group, last.begin());
    return;
  }
  for (const int k : group) roadmap_.release(k, travellers_[k], ways_[k]);
  for (std::size_t i = 0; i < group.size(); ++i) {
    ways_[group[i]] = std::move(kept[i]);
    roadmap_.reserve(group[i], travellers_[group[i]], ways_[group[i]]);
  }
}

SharedWays::Cost SharedWays::cost() const {
  Cost cost{0, 0.0};
  double last = 0.0;
  for (const Way& way : ways_) {
    if (way.end == kNever) {
      ++cost.first;
      continue;
    }
    cost.second += way.end / static_cast<double>(ways_.size());
    last = std::max(last, way.end);
  }
  cost.second += last;
  return cost;
}

std::vector<int> SharedWays::neighbours() {
  std::vector<int> group{late()};
  const Way& passes = ways_[group[0]].end == kNever ? alone_[group[0]] : ways_[group[0]];
  const std::vector<int> met = roadmap_.meetings(group[0], passes, static_cast<int>(travellers_.size()));
  while (group.size() < std::min<std::size_t>(kGroup, free_.size())) {
    int sum = 0;
    for (const int k : free_)
      if (std::ranges::find(group, k) == group.end()) sum += met[k] + 1;
    int drawn = random_.below(sum);
    for (const int k : free_) {
      if (std::ranges::find(group, k) != group.end()) continue;
      drawn -= met[k] + 1;
      if (drawn < 0) {
        group.push_back(k);
        break;
      }
    }
  }
  for (std::size_t i = group.size() - 1; i > 0; --i) std::swap(group[i], group[random_.below(static_cast<int>(i) + 1)]);
  return group;
}

int SharedWays::late() {
  const auto delay = [&](int k) { return ways_[k].end == kNever ? kNever : ways_[k].end - alone_[k].end; };
  double sum = 0.0;
  for (const int k : free_) {
    if (delay(k) == kNever && alone_[k].end < kNever) return k;
    if (delay(k) < kNever) sum += delay(k);
  }
  double drawn = random_.uniform() * sum;
  for (const int k : free_) {
    drawn -= delay(k) < kNever ? delay(k) : 0.0;
    if (drawn < 0.0) return k;
  }
  return free_[random_.below(static_cast<int>(free_.size()))];
}

Paths SharedWays::paths() const {
  Paths paths{{}, {}, order_};
  for (std::size_t k = 0; k < ways_.size(); ++k) {
    paths.ends.push_back(cut_off_[k] ? std::numeric_limits<double>::quiet_NaN() : ways_[k].end);
    for (TimedMove move : ways_[k].moves) {
      move.traveller = static_cast<int>(k);
      paths.moves.push_back(move);
    }
  }
  std::ranges::stable_sort(paths.moves, {}, &TimedMove::start);
  return paths;
}

}  // namespace muster
