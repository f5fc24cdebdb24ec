// Where units cost least that are inseparable: transports by teams, of tasks that start with others, or with tasks
// between them. Every way to place them one after the other is judged as whole routes, up to a number.
#include <algorithm>
#include <cmath>
#include <vector>

#include "plans/placement.hpp"

namespace muster {

namespace {

constexpr int kMostWays = 400;         // that are judged
constexpr int kAllTeamsOf = 6;         // robots, up to which every team of a task is tried
constexpr std::size_t kLeastCuts = 3;  // of each unit that are tried

double total_usage(const Roster& roster) {
  double total = 0.0;
  for (int robot = 0; robot < roster.problem().robots(); ++robot) total += roster.usage(robot);
  return total;
}

}  // namespace

bool Placement::best_whole(std::span<const int> units, const Trial& trial) {
  trial_ = &trial;
  best_ = UnitInsertion{};
  looks_ahead_ = false;
  Whole whole{units, {}, {}, {}, {}, kMostWays};
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (timeline_.present(unit)) whole.order.push_back(unit);
  }
  std::ranges::sort(whole.order, {}, [&](int unit) { return timeline_.label_of(unit); });
  const double share = std::pow(static_cast<double>(kMostWays), 1.0 / static_cast<double>(units.size()));
  const std::size_t most = std::max(kLeastCuts, static_cast<std::size_t>(share));
  for (const int unit : units) whole.cuts.push_back(cuts_for(unit, whole.order, most));
  place_next(whole);
  return !best_.members.empty();
}

// The cuts that leave a unit behind what it waits for and before what waits for it; of too many some.
std::vector<int> Placement::cuts_for(int unit, const std::vector<int>& order, std::size_t most) {
  const Labels allowed = roster_.timeline_.labels_for(unit);
  const int size = static_cast<int>(order.size());
  std::vector<int> cuts;
  for (int cut = trial_->append_only ? size : 0; cut <= size; ++cut) {
    const double low = cut == 0 ? 0.0 : timeline_.label_of(order[cut - 1]);
    const double high = cut == size ? 1.0 : timeline_.label_of(order[cut]);
    if (low < high && low < allowed.high && high > allowed.low && !allowed.empty()) cuts.push_back(cut);
  }
  if (cuts.size() <= most) return cuts;
  std::vector<int> some;
  for (std::size_t k = 0; k < most; ++k) {  // evenly, from where chance says
    const double from = trial_->random ? trial_->random->uniform() : 0.5;
    some.push_back(cuts[static_cast<std::size_t>((static_cast<double>(k) + from) * static_cast<double>(cuts.size()) /
                                                 static_cast<double>(most))]);
  }
  return some;
}

void Placement::place_next(Whole& whole) {
  const std::size_t k = whole.placed.size();
  if (k == whole.units.size()) return judge_whole(whole);
  const int unit = whole.units[k];
  const auto waits_for = [&](const PlacedUnit& other) {
    return std::ranges::any_of(problem_.tasks_of_unit(unit), [&](int task) {
      return std::ranges::any_of(problem_.prerequisites(task),
                                 [&](int earlier) { return problem_.unit(earlier) == other.unit; });
    });
  };
  int first = 0;
  for (std::size_t other = 0; other < k; ++other) {
    if (waits_for(whole.placed[other])) first = std::max(first, whole.cut_of[other]);
  }
  for (const int cut : whole.cuts[k]) {
    if (cut < first || whole.left <= 0 || overlooked()) continue;
    const bool is_last = cut == static_cast<int>(whole.order.size());
    whole.placed.push_back({unit, {}, is_last ? -1 : whole.order[cut]});
    whole.cut_of.push_back(cut);
    place_team(whole, 0);
    whole.placed.pop_back();
    whole.cut_of.pop_back();
  }
}

// Gives the task number k of the unit that is placed a team, and those after it.
void Placement::place_team(Whole& whole, std::size_t k) {
  const auto tasks = problem_.tasks_of_unit(whole.placed.back().unit);
  if (k == tasks.size()) return place_next(whole);
  for (const auto& team : teams_for(whole, tasks[k], static_cast<int>(k))) {
    auto& members = whole.placed.back().members;
    const std::size_t before = members.size();
    bool fits = true;
    for (const int robot : team) {
      const int at = place_in_whole(whole, robot);
      fits = fits && problem_.allowed(robot, tasks[k]) && at >= problem_.fixed(robot) &&
             !(trial_->append_only && at < timeline_.tasks_in(robot)) &&
             std::ranges::none_of(members, [&](const Member& member) { return member.robot == robot; });
      members.push_back({tasks[k], robot, at});
    }
    if (fits) place_team(whole, k + 1);
    whole.placed.back().members.resize(before);
    if (whole.left <= 0) return;
  }
}

// The teams for a task: that of the task whose load it delivers, or all of few robots, or the nearest.
Placement::Teams Placement::teams_for(const Whole& whole, int task, int k) {
  if (problem_.delivers(task)) return {team_of_pickup(whole, task)};
  relations_.look_at(whole.placed.back().unit, trial_->robots);
  std::vector<int> able;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (usable(robot, task, k)) able.push_back(robot);
  }
  if (!choice_.alone(task)) return able.size() <= kAllTeamsOf ? all_teams(task, able) : near_teams(task, able);
  Teams teams;
  for (const int robot : able) teams.push_back({robot});
  return teams;
}

std::vector<int> Placement::team_of_pickup(const Whole& whole, int task) const {
  std::vector<int> team;
  for (const PlacedUnit& placed : whole.placed) {
    for (const Member& member : placed.members) {
      if (member.task == problem_.partner(task)) team.push_back(member.robot);
    }
  }
  return team;
}

Placement::Teams Placement::all_teams(int task, const std::vector<int>& able) {
  Teams teams;
  for (std::size_t chosen = 1; chosen < std::size_t{1} << able.size(); ++chosen) {
    std::vector<int> team;
    for (std::size_t n = 0; n < able.size(); ++n) {
      if (chosen >> n & 1) team.push_back(able[n]);
    }
    if (choice_.does(task, team)) teams.push_back(team);
  }
  return teams;
}

Placement::Teams Placement::near_teams(int task, const std::vector<int>& able) {
  keys_.clear();
  for (const int robot : able) {
    const int place = timeline_.stop(robot, timeline_.tasks_in(robot)).place;
    keys_.push_back(problem_.travel_time(robot, place, task) * (trial_->random ? trial_->random->uniform() : 1.0));
  }
  TeamChoice::Ranking ranking;
  choice_.teams(task, able, keys_, std::vector<char>(able.size(), 1), ranking, teams_);
  Teams teams;
  for (int t = 0; t < teams_.size(); ++t) {
    auto& team = teams.emplace_back();
    for (const int index : teams_[t]) team.push_back(able[index]);
  }
  return teams;
}

// Behind how many tasks of its route a robot does the unit that is placed: those before its cut, and what was placed.
int Placement::place_in_whole(const Whole& whole, int robot) const {
  const int cut = whole.cut_of.back();
  int at = 0;
  const double label = cut == 0 ? -1.0 : timeline_.label_of(whole.order[cut - 1]);
  while (at < timeline_.tasks_in(robot) && timeline_.stop(robot, at + 1).label <= label) ++at;
  for (std::size_t k = 0; k + 1 < whole.placed.size(); ++k) {
    if (whole.cut_of[k] > cut) continue;
    at += static_cast<int>(
        std::ranges::count_if(whole.placed[k].members, [&](const Member& member) { return member.robot == robot; }));
  }
  return at;
}

void Placement::judge_whole(Whole& whole) {
  --whole.left;
  Routes routes = roster_.routes();
  for (const PlacedUnit& placed : whole.placed) {
    for (const Member& member : placed.members) {
      routes[member.robot].insert(routes[member.robot].begin() + member.at, member.task);
    }
  }
  if (!scratch_) scratch_ = std::make_unique<Roster>(problem_);
  if (!scratch_->begin(routes) || scratch_->timeline().end() > trial_->latest_end) return;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!problem_.fits(robot, scratch_->usage(robot))) return;
  }
  for (const int unit : whole.units) {
    for (const int task : problem_.tasks_of_unit(unit)) {
      if (!scratch_->has_rightful_team(task, choice_)) return;
    }
  }
  const double growth = total_usage(*scratch_) - total_usage(roster_);
  const double score = compared(scratch_->objective() - roster_.objective() + InsertionScore::kTie * growth);
  if (score >= best_.score) return;
  static_cast<PlacedUnit&>(best_) = whole.placed.front();
  best_.others.assign(whole.placed.begin() + 1, whole.placed.end());
  best_.score = score;
  best_.growth = growth;
}

}  // namespace muster
