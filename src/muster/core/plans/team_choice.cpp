#include "plans/team_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace muster {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Up to so many minimal covers of a task's needs each is tried; beyond it robots are added by cost until they do.
constexpr int kMostCovers = 160;
constexpr int kMostTried = 50'000;         // partial covers looked at while they are listed
constexpr double kAbilityRounding = 1e-9;  // of sums of abilities

void append(Rows& rows, std::span<const int> row) {
  rows.values.insert(rows.values.end(), row.begin(), row.end());
  rows.first.push_back(static_cast<int>(rows.values.size()));
}

}  // namespace

TeamChoice::TeamChoice(const Problem& problem)
    : problem_(problem), known_(problem.tasks(), 0), covers_(problem.tasks()) {
  number_abilities();
}

bool TeamChoice::has_needs(int task) const {
  if (problem_.abilities() == 0) return false;
  return std::ranges::any_of(problem_.needs(task), [](double need) { return need > 0.0; });
}

// Robots are alike for covers if their abilities are, and they may do the same tasks.
void TeamChoice::number_abilities() {
  std::map<std::vector<double>, int> number;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    std::vector<double> key{static_cast<double>(problem_.kind(robot))};
    if (problem_.abilities() > 0) {
      const auto abilities = problem_.ability(robot);
      key.insert(key.end(), abilities.begin(), abilities.end());
    }
    const auto [found, is_new] = number.emplace(key, static_cast<int>(class_size_.size()));
    if (is_new) {
      class_size_.push_back(0);
      class_robot_.push_back(robot);
    }
    ability_class_.push_back(found->second);
    ++class_size_[found->second];
  }
  same_.resize(class_size_.size());
}

void TeamChoice::teams(int task, std::span<const int> robots, std::span<const double> keys, std::span<const char> moved,
                       Ranking& ranking, Rows& found) {
  found.values.clear();
  found.first.assign(1, 0);
  if (has_needs(task) && covers(task).rows.size() > 0) {
    rank_anew(robots, keys, moved, ranking);
    return by_covers(task, ranking, found);
  }
  ranks_.clear();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (keys[k] < kInfinity) ranks_.emplace_back(keys[k], static_cast<int>(k));
  }
  if (has_parts(task)) {
    by_parts(task, robots, found);
  } else if (has_needs(task)) {
    by_greedy_cover(task, robots, found);
  } else if (!ranks_.empty()) {
    append(found, std::array{std::ranges::min(ranks_).second});
  }
}

bool TeamChoice::does(int task, std::span<const int> robots) {
  if (alone(task)) return robots.size() == 1;
  if (has_needs(task)) {
    const auto needs = problem_.needs(task);
    std::vector<double> missing(needs.begin(), needs.end());
    for (const int robot : robots) {
      for (std::size_t a = 0; a < missing.size(); ++a) missing[a] -= problem_.ability(robot)[a];
    }
    return covered(missing);
  }
  Rows found;
  Ranking ranking;
  teams(task, robots, std::vector<double>(robots.size(), 0.0), std::vector<char>(robots.size(), 1), ranking, found);
  return found.size() > 0 && found[0].size() == robots.size();
}

// The robots that can fill parts together are the independent sets of a matroid, so that the cheapest first is right.
void TeamChoice::by_parts(int task, std::span<const int> robots, Rows& found) {
  const auto parts = problem_.parts(task);
  if (parts.size() == 1) return by_one_part(parts.front(), robots, found);
  std::ranges::sort(ranks_);
  seats_.clear();  // the part of each seat
  for (std::size_t p = 0; p < parts.size(); ++p) seats_.insert(seats_.end(), parts[p].count, static_cast<int>(p));
  seat_of_.assign(seats_.size(), -1);
  taken_.clear();
  for (const auto& [key, index] : ranks_) {
    if (taken_.size() == seats_.size()) break;
    seen_.assign(seats_.size(), 0);
    if (give(task, robots, index)) taken_.push_back(index);
  }
  if (taken_.size() == seats_.size()) append(found, taken_);
}

void TeamChoice::by_one_part(const TeamPart& part, std::span<const int> robots, Rows& found) {
  std::erase_if(ranks_, [&](const auto& rank) { return !part.allowed[problem_.kind(robots[rank.second])]; });
  if (static_cast<int>(ranks_.size()) < part.count) return;
  std::ranges::nth_element(ranks_, ranks_.begin() + (part.count - 1));
  taken_.clear();
  for (int k = 0; k < part.count; ++k) taken_.push_back(ranks_[k].second);
  append(found, taken_);
}

// Finds a seat, by an augmenting path.
bool TeamChoice::give(int task, std::span<const int> robots, int index) {
  const auto parts = problem_.parts(task);
  for (std::size_t seat = 0; seat < seats_.size(); ++seat) {
    if (seen_[seat] || !parts[seats_[seat]].allowed[problem_.kind(robots[index])]) continue;
    seen_[seat] = 1;
    if (seat_of_[seat] < 0 || give(task, robots, seat_of_[seat])) {
      seat_of_[seat] = index;
      return true;
    }
  }
  return false;
}

// Ranks those that moved, and notes how many of each class are before the first change.
void TeamChoice::rank_anew(std::span<const int> robots, std::span<const double> keys, std::span<const char> moved,
                           Ranking& ranking) {
  ranking.resize(class_size_.size());
  for (std::size_t kind = 0; kind < ranking.size(); ++kind) same_[kind] = ranking[kind].size();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    if (!moved[k]) continue;
    const auto index = static_cast<int>(k);
    const int kind = ability_class_[robots[k]];
    auto& ranked = ranking[kind];
    const auto changed = [&](auto place) {
      same_[kind] = std::min(same_[kind], static_cast<std::size_t>(place - ranked.begin()));
    };
    const auto old = std::ranges::find(ranked, index, &std::pair<double, int>::second);
    changed(old);
    if (old != ranked.end()) ranked.erase(old);
    if (keys[k] == kInfinity) continue;
    const std::pair rank{keys[k], index};
    const auto place = std::ranges::lower_bound(ranked, rank);
    changed(place);
    ranked.insert(place, rank);
  }
}

void TeamChoice::by_covers(int task, const Ranking& ranking, Rows& found) {
  const Covers& all = covers(task);
  seen_covers_.resize(std::max<std::size_t>(seen_covers_.size(), all.rows.size()), 0);
  ++call_;
  for (std::size_t kind = 0; kind < ranking.size(); ++kind) {
    if (same_[kind] == ranking[kind].size()) continue;
    for (const int k : all.with[static_cast<int>(kind)]) {
      if (std::exchange(seen_covers_[k], call_) != call_) fill(all.rows[k], ranking, found);
    }
  }
}

// The cheapest robots of the classes of a cover, if there are so many of each and it is not the team of the last call.
void TeamChoice::fill(std::span<const int> cover, const Ranking& ranking, Rows& found) {
  taken_.clear();
  int last = -1;
  std::size_t rank = 0;
  bool is_new = false;
  for (const int kind : cover) {
    rank = kind == last ? rank + 1 : 0;
    last = kind;
    if (rank >= ranking[kind].size()) return;
    is_new |= rank >= same_[kind];
    taken_.push_back(ranking[kind][rank].second);
  }
  if (is_new) append(found, taken_);
}

// The cheapest that still bring what is missing, until nothing is; then the dearest that are needless go.
void TeamChoice::by_greedy_cover(int task, std::span<const int> robots, Rows& found) {
  const auto needs = problem_.needs(task);
  std::vector<double> missing(needs.begin(), needs.end());
  std::ranges::sort(ranks_);
  taken_.clear();
  for (const auto& [key, index] : ranks_) {
    if (covered(missing)) break;
    const auto abilities = problem_.ability(robots[index]);
    bool helps = false;
    for (std::size_t a = 0; a < missing.size(); ++a) helps |= missing[a] > kAbilityRounding && abilities[a] > 0.0;
    if (!helps) continue;
    for (std::size_t a = 0; a < missing.size(); ++a) missing[a] -= abilities[a];
    taken_.push_back(index);
  }
  if (!covered(missing)) return;
  for (std::size_t k = taken_.size(); k-- > 0;) {
    const auto abilities = problem_.ability(robots[taken_[k]]);
    bool needed = false;
    for (std::size_t a = 0; a < missing.size(); ++a) needed |= missing[a] + abilities[a] > kAbilityRounding;
    if (needed) continue;
    for (std::size_t a = 0; a < missing.size(); ++a) missing[a] += abilities[a];
    taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  append(found, taken_);
}

bool TeamChoice::covered(std::span<const double> missing) const {
  return std::ranges::all_of(missing, [](double amount) { return amount <= kAbilityRounding; });
}

const TeamChoice::Covers& TeamChoice::covers(int task) {
  Covers& found = covers_[task];
  if (std::exchange(known_[task], 1)) return found;
  const auto needs = problem_.needs(task);
  std::vector<double> missing(needs.begin(), needs.end());
  std::vector<int> counts(class_size_.size(), 0);
  budget_ = kMostTried;
  cover(task, 0, missing, counts, found.rows);
  if (found.rows.size() > kMostCovers || budget_ < 0) found.rows = Rows{};
  for (std::size_t kind = 0; kind < class_size_.size(); ++kind) {
    std::vector<int> with;
    for (int k = 0; k < found.rows.size(); ++k) {
      if (std::ranges::count(found.rows[k], static_cast<int>(kind)) > 0) with.push_back(k);
    }
    append(found.with, with);
  }
  return found;
}

// All ways to cover what is missing with robots of the classes from `kind` on, none of them needless.
void TeamChoice::cover(int task, int kind, std::vector<double>& missing, std::vector<int>& counts, Rows& found) {
  if (found.size() > kMostCovers || --budget_ < 0) return;
  if (covered(missing)) {
    if (needless(task, counts)) return;
    std::vector<int> row;
    for (std::size_t k = 0; k < counts.size(); ++k) row.insert(row.end(), counts[k], static_cast<int>(k));
    append(found, row);
    return;
  }
  if (kind == static_cast<int>(counts.size())) return;
  const std::vector<double> before = missing;
  const auto abilities = problem_.ability(class_robot_[kind]);
  const int most = problem_.allowed(class_robot_[kind], task) ? class_size_[kind] : 0;
  for (int count = 0; count <= most; ++count) {
    counts[kind] = count;
    for (std::size_t a = 0; a < missing.size(); ++a) missing[a] = before[a] - count * abilities[a];
    cover(task, kind + 1, missing, counts, found);
    if (count > 0 && covered(missing)) break;
  }
  counts[kind] = 0;
  missing = before;
}

bool TeamChoice::needless(int task, const std::vector<int>& counts) const {
  const auto needs = problem_.needs(task);
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    bool enough = true;
    for (std::size_t a = 0; a < needs.size() && enough; ++a) {
      double sum = 0.0;
      for (std::size_t k = 0; k < counts.size(); ++k) {
        sum += (counts[k] - (k == kind)) * problem_.ability(class_robot_[k])[a];
      }
      enough = sum >= needs[a] - kAbilityRounding;
    }
    if (enough) return true;
  }
  return false;
}

}  // namespace muster
