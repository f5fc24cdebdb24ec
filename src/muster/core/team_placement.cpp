// Teams, and tasks that start together: one place for every robot at each cut through the labels.
#include <algorithm>
#include <cmath>
#include <utility>

#include "placement.hpp"

namespace muster {

namespace {

constexpr int kKeys = 3;           // ways to rank robots
constexpr double kFirstKey = 0.5;  // how often an algorithm with random numbers takes the first at a cut

}  // namespace

void Placement::try_cuts(int unit) {
  const auto tasks = problem_.tasks_of_unit(unit);
  candidates_.clear();
  at_.clear();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (std::ranges::any_of(tasks, [&](int task) { return usable(robot, task); })) candidates_.push_back(robot);
  }
  at_.assign(candidates_.size(), -1);
  offers_.resize(tasks.size() * candidates_.size());
  gather_cuts(unit);
  for (const double cut : cuts_) {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (pass(c, cut)) make_offers(unit, c);
    }
    if (!overlooked()) try_cut(unit);
  }
}

// The labels after which a cut may lie, in order: that of what comes before the unit, and those of all units between it
// and what comes after.
void Placement::gather_cuts(int unit) {
  cuts_.assign(1, labels_.low);
  const auto add = [&](double label) {
    if (label > labels_.low && label < labels_.high) cuts_.push_back(label);
  };
  long count = 0;
  for (const int robot : candidates_) count += timeline_.tasks_in(robot);
  if (trial_->append_only) {
    for (const int robot : candidates_) add(timeline_.stop(robot, timeline_.tasks_in(robot)).label);
  } else if (trial_->most_places > 0 && count > 4 * trial_->most_places) {
    for (const int task : problem_.tasks_of_unit(unit)) {
      int tried = 0;
      for (const int near : trial_->neighbours->of(task)) {
        const auto visits = timeline_.visits_of(problem_.unit(near));
        if (visits.empty()) continue;
        const Visit& visit = timeline_.visit(visits.front());
        add(visit.label);
        add(timeline_.stop(visit.robot, visit.at - 1).label);
        if (++tried >= trial_->most_places / 2) break;
      }
    }
    for (const int robot : candidates_) add(timeline_.stop(robot, timeline_.tasks_in(robot)).label);
  } else {
    for (const int robot : candidates_) {
      for (const int number : timeline_.route(robot)) {
        if (timeline_.visit(number).unit >= 0) add(timeline_.visit(number).label);
      }
    }
  }
  std::ranges::sort(cuts_);
  cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
  if (trial_->append_only) cuts_.erase(cuts_.begin(), cuts_.end() - 1);
}

// Moves a robot's place behind all that lies before the cut; tells whether it moved.
bool Placement::pass(std::size_t candidate, double cut) {
  const int robot = candidates_[candidate];
  int at = std::max(0, at_[candidate]);
  while (timeline_.stop(robot, at + 1).unit >= 0 && timeline_.stop(robot, at + 1).label <= cut) ++at;
  return std::exchange(at_[candidate], at) != at;
}

void Placement::make_offers(int unit, std::size_t candidate) {
  const int robot = candidates_[candidate];
  const auto tasks = problem_.tasks_of_unit(unit);
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    Offer& made = offers_[k * candidates_.size() + candidate];
    made.robot = -1;
    if (at_[candidate] < problem_.fixed(robot) || !usable(robot, tasks[k])) continue;
    if (trial_->append_only && at_[candidate] < timeline_.tasks_in(robot)) continue;
    const double work = problem_.work_time(robot, tasks[k]);
    made = offer(robot, tasks[k], at_[candidate], work);
    measure_usage(made, tasks[k]);
    if (!timeline_.in_time(std::max(ready_, made.arrive) + work, made.latest) ||
        !problem_.fits(robot, made.usage + made.growth)) {
      made.robot = -1;
    }
  }
}

void Placement::try_cut(int unit) {
  if (!trial_->random) {
    for (int key = 0; key < kKeys; ++key) try_key(unit, key);
  } else {
    try_key(unit, trial_->random->uniform() < kFirstKey ? 0 : 1 + trial_->random->below(kKeys - 1));
  }
}

// Robots are ranked by what they cost the objective, by when they come, or by how long the mission takes through them.
double Placement::key_of(const Offer& offer, int key) const {
  if (key == 1) return offer.arrive;
  if (problem_.objective() == Objective::makespan) {
    if (key == 2) return offer.arrive + offer.onward;
    return offer.in + offer.out - offer.direct;
  }
  if (key == 2) return problem_.objective() == Objective::average ? offer.late : offer.usage + offer.growth;
  return offer.growth;
}

void Placement::try_key(int unit, int key) {
  const auto tasks = problem_.tasks_of_unit(unit);
  const bool single = tasks.size() == 1;
  members_.clear();
  team_.clear();
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const Offer* offers = offers_.data() + k * candidates_.size();
    keys_.resize(candidates_.size());
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      keys_[c] = offers[c].robot < 0 || busy_[candidates_[c]] ? kNever : key_of(offers[c], key);
    }
    choice_.teams(tasks[k], candidates_, keys_, teams_);
    int cheapest = -1;
    double least = kNever;
    for (int t = 0; t < teams_.size(); ++t) {
      if (team_size_ >= 0 && static_cast<int>(teams_[t].size()) != team_size_) continue;
      if (single) {
        members_.clear();
        team_.clear();
        for (const int c : teams_[t]) {
          members_.push_back({tasks[k], candidates_[c], at_[c]});
          team_.push_back(&offers[c]);
        }
        judge(unit);
        continue;
      }
      double sum = 0.0;
      for (const int c : teams_[t]) sum += keys_[c];
      if (sum < least) {
        least = sum;
        cheapest = t;
      }
    }
    if (single) return;
    if (cheapest < 0) break;
    for (const int c : teams_[cheapest]) {
      members_.push_back({tasks[k], candidates_[c], at_[c]});
      team_.push_back(&offers[c]);
      busy_[candidates_[c]] = 1;
    }
    if (k + 1 == tasks.size()) judge(unit);
  }
  for (const Member& member : members_) busy_[member.robot] = 0;
}

// What it costs that these members do the unit's tasks.
void Placement::judge(int unit) {
  const auto tasks = problem_.tasks_of_unit(unit);
  works_.assign(tasks.size(), 0.0);
  double begin = ready_;
  const auto number = [&](int task) {
    return static_cast<std::size_t>(std::ranges::find(tasks, task) - tasks.begin());
  };
  for (std::size_t m = 0; m < members_.size(); ++m) {
    double& work = works_[number(members_[m].task)];
    work = std::max(work, team_[m]->work);
    begin = std::max(begin, team_[m]->arrive);
  }
  begin = timeline_.open(unit, begin);
  if (!timeline_.in_time(begin, timeline_.latest_for(unit, works_))) return;
  InsertionScore score(problem_.objective(), peak_);
  double late = 0.0;
  const bool looks_late = problem_.objective() == Objective::lateness;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const double work = works_[number(members_[m].task)];
    if (!timeline_.in_time(begin + work, team_[m]->latest)) return;
    if (problem_.usage_is_time() && work > team_[m]->work) {
      Offer slower = *team_[m];
      slower.growth += work - slower.work;
      if (!problem_.fits(slower.robot, slower.usage + slower.growth)) return;
      score.add(slower, begin, work);
    } else {
      score.add(*team_[m], begin, work);
    }
    if (looks_late) late += delays(*team_[m], begin + work);
  }
  if (looks_late) {
    for (std::size_t k = 0; k < tasks.size(); ++k) late += lateness(tasks[k], begin + works_[k]);
  }
  const double value = score.value(begin, timeline_.tail_after(unit, works_), late);
  if (value >= best_.score) return;
  best_.score = value;
  best_.growth = score.growth();
  best_.members = members_;
}

}  // namespace muster
