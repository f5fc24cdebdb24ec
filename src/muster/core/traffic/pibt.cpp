#include "traffic/pibt.hpp"

#include <algorithm>
#include <utility>

namespace muster {

Pibt::Pibt(std::shared_ptr<GoalDistances> distances, std::uint64_t seed)
    : distances_(std::move(distances)),
      followed_(distances_->goals().size(), distances_.get()),
      graph_(distances_->graph()),
      random_(seed),
      now_(graph_.size(), kNobody),
      next_(graph_.size(), kNobody),
      width_(graph_.most_neighbours() + 1),
      candidates_(static_cast<std::size_t>(distances_->robots()) * width_),
      keys_(graph_.size()) {}

bool Pibt::step(const Places& from, Places& to, std::span<const int> order) {
  for (int i = 0; i < robots(); ++i) now_[from[i]] = i;
  bool found = !conflicts(from, to);
  for (std::size_t k = 0; k < order.size() && found; ++k) {
    found = to[order[k]] != kUndecided || decide(order[k], from, to);
  }
  for (int i = 0; i < robots(); ++i) {
    now_[from[i]] = kNobody;
    if (to[i] != kUndecided) next_[to[i]] = kNobody;
  }
  return found;
}

// Takes what is decided for taken; whether two would meet.
bool Pibt::conflicts(const Places& from, const Places& to) {
  bool found = false;
  for (int i = 0; i < robots(); ++i) {
    if (to[i] == kUndecided) continue;
    const int there = now_[to[i]];
    found = found || next_[to[i]] != kNobody || (there != kNobody && there != i && to[there] == from[i]);
    next_[to[i]] = i;
  }
  return found;
}

bool Pibt::decide(int robot, const Places& from, Places& to) {
  const int at = from[robot];
  const auto neighbours = graph_.neighbours(at);
  const std::span<int> candidates(candidates_.data() + static_cast<std::size_t>(robot) * width_, neighbours.size() + 1);
  rank(robot, at, candidates);
  const int partner = to_swap_with(robot, candidates[0], from, to);
  if (partner != kNobody) std::reverse(candidates.begin(), candidates.end());
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const int there = candidates[k];
    if (next_[there] != kNobody) continue;
    const int who = now_[there];
    if (who != kNobody && to[who] == at) continue;
    next_[there] = robot;
    to[robot] = there;
    if (who != kNobody && there != at && to[who] == kUndecided && !decide(who, from, to)) continue;
    if (k == 0 && partner != kNobody && to[partner] == kUndecided && next_[at] == kNobody &&
        graph_.edge(from[partner], at) >= 0) {
      next_[at] = partner;  // pulls it along
      to[partner] = at;
    }
    return true;
  }
  next_[at] = robot;
  to[robot] = at;
  return false;
}

// The neighbours and the vertex itself, nearest to the goal first, ties by chance.
void Pibt::rank(int robot, int at, std::span<int> candidates) {
  const auto neighbours = graph_.neighbours(at);
  std::copy(neighbours.begin(), neighbours.end(), candidates.begin());
  candidates.back() = at;
  keys_[at] = distance(robot, at);
  for (const int there : neighbours) keys_[there] = distance(robot, there) + random_.uniform();
  std::sort(candidates.begin(), candidates.end(), [&](int a, int b) { return keys_[a] < keys_[b]; });
}

int Pibt::to_swap_with(int robot, int best, const Places& from, const Places& to) {
  const int at = from[robot];
  if (best == at) return kNobody;
  const int ahead = now_[best];
  if (ahead != kNobody && to[ahead] == kUndecided && swap_is_needed(robot, ahead, at, best) &&
      swap_is_possible(best, at)) {
    return ahead;
  }
  // Somebody behind will need it in a moment: make room for that.
  for (const int beside : graph_.neighbours(at)) {
    const int who = now_[beside];
    if (who != kNobody && who != ahead && swap_is_needed(who, robot, at, best) && swap_is_possible(best, at))
      return who;
  }
  return kNobody;
}

// Follows both, the puller pushed on: do they meet a place where one may step aside before they have to swap?
bool Pibt::swap_is_needed(int pusher, int puller, int pusher_at, int puller_at) const {
  while (distance(pusher, puller_at) < distance(pusher, pusher_at)) {
    const auto [ways, on] = ways_on(puller_at, pusher_at);
    if (ways >= 2) return false;
    if (ways == 0) break;
    pusher_at = std::exchange(puller_at, on);
  }
  return distance(puller, pusher_at) < distance(puller, puller_at) &&
         (distance(pusher, pusher_at) == 0 || distance(pusher, puller_at) < distance(pusher, pusher_at));
}

// Pulls back until there is a place where one may step aside.
bool Pibt::swap_is_possible(int pusher_at, int puller_at) const {
  const int begin = pusher_at;
  for (int k = 0; k < graph_.size() && puller_at != begin; ++k) {  // one-way edges may lead into a circle
    const auto [ways, on] = ways_on(puller_at, pusher_at);
    if (ways >= 2) return true;
    if (ways == 0) return false;
    pusher_at = std::exchange(puller_at, on);
  }
  return false;
}

std::pair<int, int> Pibt::ways_on(int at, int behind) const {
  int ways = 0, on = at;
  for (const int there : graph_.neighbours(at)) {
    const int who = now_[there];
    const bool rests = graph_.neighbours(there).size() == 1 && who != kNobody && goal(who) == there;
    if (there == behind || rests) continue;
    ++ways;
    on = there;
  }
  return {ways, on};
}

}  // namespace muster
