#include "traffic/shared_ways.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "infinity.hpp"

namespace muster {

namespace {

constexpr double kTailsToLeave[] = {4.0, 25.0};
constexpr int kGroup = 4;          // travellers that are planned anew at a time
constexpr int kTries = 8;          // orders in which all make way for each other, of which the best counts
constexpr double kMostAhead = 10;  // rounds that a try puts a traveller ahead
constexpr double kChanged = 0.3;   // the share of travellers whose priorities a try changes
constexpr double kWorse = 0.02;    // the share by which ways may get worse at first
constexpr int kMoreWhereLost = 4;  // times as many ways are sought where some find none

}  // namespace

SharedWays::SharedWays(SafeIntervals& roadmap, std::vector<Traveller> travellers, std::vector<int> order,
                       const Effort& effort, std::uint64_t seed)
    : roadmap_(roadmap), random_(seed), budget_(effort.budget) {
  const std::size_t n = travellers.size();
  now_ = {std::move(travellers), std::move(order),    {},
          std::vector<char>(n),  std::vector<Way>(n), std::vector<Way>(n, {{}, 0.0, kNever})};
  std::ranges::copy_if(now_.order, std::back_inserter(now_.free), [&](int k) { return !now_.travellers[k].fixed; });
  clear();
  for (int k = 0; k < static_cast<int>(n); ++k) find_alone(k);
  if (effort.at_once)
    for (const int k : now_.free) now_.ways[k].end = kNever;
  else
    plan_all();
  const bool some_lost = cost().first > 0;
  if (some_lost) take_turns(effort.expansions);
  improve(some_lost && cost().first == 0 ? kMoreWhereLost * effort.ways : effort.ways);
}

// Those that are planned later are given a short time to leave their starts, so that few do not go round each other, or
// a long one, so that a crowd can leave one after the other.
void SharedWays::plan_all() {
  std::optional<State> best;
  Cost least;
  for (const double tails : kTailsToLeave) {
    now_.tails_to_leave = tails;
    clear();
    plan(now_.free);
    if (!best || cost() < least) {
      least = cost();
      best = now_;
    }
    if (budget_.is_spent()) break;
  }
  now_ = *std::move(best);
  clear();
  put_on_all_but({});
}

// All go at once, and make way for each other; their moves are made as soon as those before them let them.
void SharedWays::take_turns(int expansions) {
  JointMoves joint = roadmap_.joint_moves();
  State best = now_;
  Cost least = cost();
  std::vector<double> ahead(now_.travellers.size());
  for (int k = 0; k < kTries; ++k) {
    std::vector<double> changed = ahead;
    for (double& rounds : changed)
      if (k > 0 && random_.uniform() < kChanged) rounds = kMostAhead * random_.uniform();
    const std::vector<SingleMove> moves = joint.moves(now_.travellers, changed, expansions, random_.next());
    spend(joint.take_expansions());
    clear();
    now_.ways = roadmap_.in_turn(now_.travellers, moves);
    now_.all_rest = true;
    if (cost() < least) {
      least = cost();
      best = now_;
      ahead = std::move(changed);
    }
    if (cost().first > 0 || budget_.is_spent()) break;  // further tries take long, and hardly get through
  }
  now_ = std::move(best);
  clear();
  put_on_all_but({});
}

void SharedWays::change(const std::vector<std::pair<int, Traveller>>& changes, int ways) {
  before_ = now_;
  std::vector<int> changed;
  for (const auto& [k, who] : changes) {
    now_.travellers[k] = who;
    changed.push_back(k);
  }
  clear();
  for (const int k : changed) find_alone(k);
  put_on_all_but(changed);
  plan(changed);
  move_back(changed);
  improve(ways);
}

void SharedWays::clear() {
  roadmap_.clear();
  for (const Traveller& who : now_.travellers) roadmap_.want(who);
  for (int k = 0; k < static_cast<int>(now_.travellers.size()); ++k)
    if (now_.travellers[k].fixed) roadmap_.reserve(k, now_.travellers[k], now_.ways[k]);
}

void SharedWays::put_on_all_but(std::span<const int> group) {
  for (const int k : now_.free)
    if (std::ranges::find(group, k) == group.end()) roadmap_.reserve(k, now_.travellers[k], now_.ways[k]);
}

// Stops to which no way leads past those who never leave, and those after them, are left out.
void SharedWays::find_alone(int traveller) {
  Traveller& who = now_.travellers[traveller];
  Way& found = now_.alone[traveller];
  const bool goes = !who.fixed && !who.stops.empty();
  found = who.fixed ? Way{{}, 0.0, kNever} : way(traveller);
  while (!who.fixed && !who.stops.empty() && found.end == kNever) {
    who.stops.pop_back();
    who.stays = false;
    found = way(traveller);
  }
  now_.cut_off[traveller] = goes && who.stops.empty();
}

// Where all made way for each other, ways may get a little worse at a time, so that the search leaves local optima.
void SharedWays::improve(int ways) {
  const auto delayed = [&](int k) { return now_.ways[k].end > now_.alone[k].end; };
  const double worse = now_.all_rest ? kWorse : 0.0;
  State best = now_;
  Cost least = cost();
  for (int sought = 0; std::ranges::any_of(now_.free, delayed);) {
    if (sought >= (cost().first > 0 ? kMoreWhereLost : 1) * ways || budget_.is_spent()) break;
    const std::vector<int> group = neighbours();
    sought += static_cast<int>(group.size());
    replan(group, worse * (1.0 - static_cast<double>(sought) / ways));
    if (worse > 0.0 && cost() < least) {
      least = cost();
      best = now_;
    }
  }
  if (!(least < cost())) return;
  now_ = std::move(best);
  clear();
  put_on_all_but({});
}

void SharedWays::plan(std::span<const int> group) {
  for (const int k : group) roadmap_.reserve_start(k, now_.travellers[k], now_.tails_to_leave);
  for (const int k : group) {
    roadmap_.release_start(k, now_.travellers[k]);
    now_.ways[k] = way(k);
    roadmap_.reserve(k, now_.travellers[k], now_.ways[k]);
  }
}

void SharedWays::replan(const std::vector<int>& group, double worse) {
  const Cost before = cost();
  std::vector<Way> kept;
  for (const int k : group) {
    roadmap_.release(k, now_.travellers[k], now_.ways[k]);
    kept.push_back(now_.ways[k]);
  }
  plan(group);
  if (cost() < Cost{before.first, before.second * (1.0 + std::max(0.0, worse))}) {
    move_back(group);
    return;
  }
  for (const int k : group) roadmap_.release(k, now_.travellers[k], now_.ways[k]);
  for (std::size_t i = 0; i < group.size(); ++i) {
    now_.ways[group[i]] = std::move(kept[i]);
    roadmap_.reserve(group[i], now_.travellers[group[i]], now_.ways[group[i]]);
  }
}

void SharedWays::move_back(const std::vector<int>& group) {
  const auto stays = [&](int k) { return std::ranges::find(group, k) == group.end(); };
  const auto last = std::ranges::stable_partition(now_.order, stays);
  std::ranges::copy(group, last.begin());
}

SharedWays::Cost SharedWays::cost() const {
  Cost cost{0, 0.0};
  double last = 0.0;
  for (const Way& way : now_.ways) {
    if (way.end == kNever || (now_.all_rest && way.until < kNever)) {
      ++cost.first;
      continue;
    }
    cost.second += way.end / static_cast<double>(now_.ways.size());
    last = std::max(last, way.end);
  }
  cost.second += last;
  return cost;
}

std::vector<int> SharedWays::neighbours() {
  std::vector<int> group{late()};
  const Way& passes = now_.ways[group[0]].end == kNever ? now_.alone[group[0]] : now_.ways[group[0]];
  const std::vector<int> met = roadmap_.meetings(group[0], passes, static_cast<int>(now_.travellers.size()));
  while (group.size() < std::min<std::size_t>(kGroup, now_.free.size())) {
    int sum = 0;
    for (const int k : now_.free)
      if (std::ranges::find(group, k) == group.end()) sum += met[k] + 1;
    int drawn = random_.below(sum);
    for (const int k : now_.free) {
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
  const auto delay = [&](int k) { return now_.ways[k].end == kNever ? kNever : now_.ways[k].end - now_.alone[k].end; };
  double sum = 0.0;
  for (const int k : now_.free) {
    if (delay(k) == kNever && now_.alone[k].end < kNever) return k;
    if (delay(k) < kNever) sum += delay(k);
  }
  double drawn = random_.uniform() * sum;
  for (const int k : now_.free) {
    drawn -= delay(k) < kNever ? delay(k) : 0.0;
    if (drawn < 0.0) return k;
  }
  return now_.free[random_.below(static_cast<int>(now_.free.size()))];
}

Way SharedWays::way(int traveller) {
  Way found = roadmap_.way(now_.travellers[traveller]);
  spend(roadmap_.take_expansions());
  return found;
}

void SharedWays::spend(std::int64_t expansions) {
  expansions_ += expansions;
  budget_.spend(expansions);
}

Paths SharedWays::paths() const {
  Paths found = paths(now_.ways);
  for (std::size_t k = 0; k < found.ends.size(); ++k)
    if (now_.cut_off[k]) found.ends[k] = std::numeric_limits<double>::quiet_NaN();
  return found;
}

Paths SharedWays::paths_alone() const { return paths(now_.alone); }

Paths SharedWays::paths(const std::vector<Way>& ways) const {
  Paths paths;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    paths.ends.push_back(ways[k].end);
    for (TimedMove move : ways[k].moves) {
      move.traveller = static_cast<int>(k);
      paths.moves.push_back(move);
    }
  }
  std::ranges::stable_sort(paths.moves, {}, &TimedMove::start);
  return paths;
}

}  // namespace muster
