// Teams, and tasks that start together: one place for every robot at each cut through the labels.
#include <algorithm>
#include <cmath>
#include <utility>

#include "plans/placement.hpp"

namespace muster {

namespace {

constexpr std::size_t kPassedAtOnce = 4;  // robots that are looked at in the time in which a unit is passed
constexpr double kFirstKey = 0.5;         // how often an algorithm with random numbers takes the first

}  // namespace

void Placement::try_cuts(int unit) {
  const auto tasks = problem_.tasks_of_unit(unit);
  candidates_.clear();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    bool any = false;
    for (std::size_t k = 0; k < tasks.size(); ++k) any |= usable(robot, tasks[k], static_cast<int>(k));
    if (any) candidates_.push_back(robot);
  }
  if (candidates_.size() > 1 && overlooked()) {  // a robot, as a place of a task for one is
    candidates_.erase(candidates_.begin() + trial_->random->below(static_cast<int>(candidates_.size())));
  }
  offers_.assign(tasks.size() * candidates_.size(), Offer{});
  gather_cuts(unit);
  everyone_.assign(candidates_.size(), 1);
  works_.assign(tasks.size(), 0.0);
  tail_ = timeline_.tail_after(unit, works_);
  for (auto& moved : moved_) moved.assign(candidates_.size(), 1);
  for (auto& ranking : rankings_) {
    for (auto& ranked : ranking) ranked.clear();
  }
  walk_cuts(unit, [&] { try_cut(unit); });
  // The cheapest robots may not have the time to wait for each other; maybe others have.
  if (best_.members.empty() && problem_.has_time_limits()) walk_cuts(unit, [&] { try_hard(unit); });
}

// Gives each robot its place at one cut after the other, and tries teams there.
template <class Try>
void Placement::walk_cuts(int unit, Try&& attempt) {
  stand_at_first_cut();
  for (const Cut& cut : cuts_) {
    if (skips_cuts_) {
      pass_up_to(cut.label);
    } else if (cut.behind >= 0) {
      pass(cut.behind);
    }
    if (cut.tried && renew_offers(unit) && !overlooked()) attempt();
  }
}

void Placement::try_cut(int unit) {
  const auto tasks = problem_.tasks_of_unit(unit).size();
  if (!trial_->random) {
    for (int key = 0; key < kByRoom; ++key) {
      for (std::size_t first = 0; first < tasks; ++first) try_key(unit, key, first);
    }
    return;
  }
  const int key = trial_->random->uniform() < kFirstKey ? 0 : 1 + trial_->random->below(kByRoom - 1);
  try_key(unit, key, tasks == 1 ? 0 : trial_->random->below(static_cast<int>(tasks)));
}

// Robots with the most time first, and each task of the unit first in turn.
void Placement::try_hard(int unit) {
  const auto tasks = problem_.tasks_of_unit(unit).size();
  for (int key = tasks == 1 ? kByRoom : 0; key < kKeys; ++key) {
    for (std::size_t first = 0; first < tasks; ++first) try_key(unit, key, first);
  }
}

void Placement::try_key(int unit, int key, std::size_t first) {
  if (problem_.tasks_of_unit(unit).size() == 1) {
    try_teams(unit, key);
  } else {
    try_together(unit, key, first);
  }
}

// The cuts between what comes before the unit and what comes after it, in order: all, or some of many.
void Placement::gather_cuts(int unit) {
  cuts_.assign(1, {labels_.low, -1, true});
  skips_cuts_ = trial_->append_only;
  if (trial_->append_only) return;  // behind all that may come before the unit
  const bool some = seek_near(unit);
  // To pass many cuts one by one takes longer than to look at each robot at some.
  skips_cuts_ = some && near_units_.size() * candidates_.size() < kPassedAtOnce * near_.size();
  const auto add = [&](int other, bool tried) {
    const double label = timeline_.label_of(other);
    if (timeline_.present(other) && label > labels_.low && label < labels_.high) cuts_.push_back({label, other, tried});
  };
  if (skips_cuts_) {
    for (const int other : near_units_) add(other, true);
  } else {
    for (const int other : near_units_) near_[other] = 1;
    for (int other = 0; other < problem_.units(); ++other) add(other, !some || near_[other]);
    for (const int other : near_units_) near_[other] = 0;
  }
  std::ranges::sort(cuts_, {}, &Cut::label);
  for (std::size_t k = 1; k < cuts_.size(); ++k) {  // there is no cut between units of one label
    if (cuts_[k - 1].label == cuts_[k].label) cuts_[k].tried |= std::exchange(cuts_[k - 1].tried, false);
  }
}

// Finds the units behind and before those near ones, and the last of each route. False: all cuts are few enough.
bool Placement::seek_near(int unit) {
  near_units_.clear();
  long count = 0;
  for (const int robot : candidates_) count += timeline_.tasks_in(robot);
  if (trial_->most_places == 0 || count <= 4 * trial_->most_places) return false;
  const auto mark = [&](const Visit& visit) {
    if (visit.unit >= 0) near_units_.push_back(visit.unit);
  };
  for (const int task : problem_.tasks_of_unit(unit)) {
    int tried = 0;
    for (const int near : trial_->neighbours->of(task)) {
      const auto visits = timeline_.visits_of(problem_.unit(near));
      if (visits.empty()) continue;
      mark(timeline_.visit(visits.front()));
      for (const int number : visits)
        mark(timeline_.stop(timeline_.visit(number).robot, timeline_.visit(number).at - 1));
      if (++tried >= trial_->most_places / 2) break;
    }
  }
  for (const int robot : candidates_) mark(timeline_.stop(robot, timeline_.tasks_in(robot)));
  return true;
}

void Placement::stand_at_first_cut() {
  candidate_of_.assign(problem_.robots(), -1);
  at_.resize(candidates_.size());
  passed_.resize(candidates_.size());
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const auto& route = timeline_.route(candidates_[c]);
    const auto before = [&](int number) {
      const double label = timeline_.visit(number).label;
      return trial_->append_only ? label < labels_.high : label <= labels_.low;
    };
    at_[c] = static_cast<int>(std::partition_point(route.begin() + 1, route.end() - 1, before) - route.begin()) - 1;
    candidate_of_[candidates_[c]] = passed_[c] = static_cast<int>(c);
  }
}

// Moves the places of its robots behind a unit.
void Placement::pass(int unit) {
  for (const int number : timeline_.visits_of(unit)) {
    const Visit& visit = timeline_.visit(number);
    const int candidate = candidate_of_[visit.robot];
    if (candidate < 0) continue;
    at_[candidate] = visit.at;
    passed_.push_back(candidate);
  }
}

// Moves the places of all robots behind everything up to a label.
void Placement::pass_up_to(double label) {
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const int robot = candidates_[c], before = at_[c], size = timeline_.tasks_in(robot);
    while (at_[c] < size && timeline_.stop(robot, at_[c] + 1).label <= label) ++at_[c];
    if (at_[c] != before) passed_.push_back(static_cast<int>(c));
  }
}

// What robots offer at their new places. False: nothing, as before.
bool Placement::renew_offers(int unit) {
  bool any_moved = false;
  for (const int candidate : passed_) {
    const bool could = offered(candidate);
    make_offers(unit, candidate);
    if (!could && !offered(candidate)) continue;
    any_moved = true;
    for (auto& moved : moved_) moved[candidate] = 1;
  }
  passed_.clear();
  return any_moved;
}

// Whether a robot could do any task of the unit where it stands.
bool Placement::offered(std::size_t candidate) const {
  for (std::size_t k = candidate; k < offers_.size(); k += candidates_.size()) {
    if (offers_[k].robot >= 0) return true;
  }
  return false;
}

void Placement::make_offers(int unit, std::size_t candidate) {
  const int robot = candidates_[candidate];
  const auto tasks = problem_.tasks_of_unit(unit);
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    Offer& made = offers_[k * candidates_.size() + candidate];
    made.robot = -1;
    if (at_[candidate] < problem_.fixed(robot) || !usable(robot, tasks[k], static_cast<int>(k))) continue;
    if (trial_->append_only && at_[candidate] < timeline_.tasks_in(robot)) continue;
    if (!in_reach(robot, tasks[k], at_[candidate]) || !has_room(robot, tasks[k], at_[candidate])) continue;
    const double work = problem_.work_time(robot, tasks[k]);
    made = arrival(robot, tasks[k], at_[candidate], work);
    const Added added{at_[candidate], tasks[k]};
    if (!may_join(made, tasks[k]) || !keeps_length(robot, {&added, 1})) made.robot = -1;
  }
}

// Measures the rest of an offer; tells whether its robot could be a member of the best team.
bool Placement::may_join(Offer& offer, int task) const {
  if (hopeless(offer)) return false;
  go_on(offer, task);
  if (hopeless(offer)) return false;
  measure_usage(offer, task);
  return timeline_.in_time(std::max(ready_, offer.arrive) + offer.work, offer.latest) &&
         problem_.fits(offer.robot, offer.usage + offer.growth);
}

// Robots are ranked by what they cost the objective, by when they come, by how long the mission takes through them, or
// by how late they could still end.
double Placement::key_of(const Offer& offer, int key) const {
  if (key == kByRoom) return -offer.latest;
  if (key == 1) return offer.arrive;
  if (problem_.objective() == Objective::makespan) {
    if (key == 2) return offer.arrive + offer.onward;
    return offer.in + offer.out - offer.direct;
  }
  if (key == 2) return problem_.objective() == Objective::average ? offer.late : offer.usage + offer.growth;
  return offer.growth;
}

void Placement::rank(int task, int k, int key) {
  const bool single = looks_ahead_ && choice_.alone(task);
  const Offer* offers = offers_.data() + k * candidates_.size();
  keys_.resize(candidates_.size());
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const bool out =
        offers[c].robot < 0 || busy_[candidates_[c]] || (single && !suits(relations_.awaited(k), {&candidates_[c], 1}));
    keys_[c] = out ? kNever : compared(key_of(offers[c], key));
  }
}

// The teams for one task; those of earlier cuts whose members all stand where they stood were judged there.
void Placement::try_teams(int unit, int key) {
  const int task = problem_.tasks_of_unit(unit).front();
  rank(task, 0, key);
  if (relations_.team_size(0) >= 0) {
    team_.clear();
    if (take_tied(task, 0)) judge(unit);
    return;
  }
  if (looks_ahead_) return try_shared(task, unit);
  choice_.teams(task, candidates_, keys_, moved_[key], rankings_[key], teams_);
  std::ranges::fill(moved_[key], 0);
  for (int t = 0; t < teams_.size(); ++t) {
    team_.clear();
    for (const int c : teams_[t]) team_.push_back({0, &offers_[c]});
    judge(unit);
  }
}

// The teams of a task and those of the tasks that its robots have to do too, as far as they can do all of them.
void Placement::try_shared(int task, int unit) {
  const auto judge_teams_of = [&](int source) {
    choose_anew(source);
    for (int t = 0; t < teams_.size(); ++t) {
      team_.clear();
      robots_.clear();
      for (const int c : teams_[t]) {
        team_.push_back({0, &offers_[c]});
        robots_.push_back(candidates_[c]);
      }
      if (source == task || choice_.does(task, robots_)) judge(unit);
    }
  };
  judge_teams_of(task);
  for (const int other : relations_.awaited(0)) judge_teams_of(other);
}

// One after the other the tasks of a unit, each with its cheapest team of those that are left.
void Placement::try_together(int unit, int key, std::size_t first) {
  const auto tasks = problem_.tasks_of_unit(unit);
  team_.clear();
  bool complete = true;
  for (std::size_t n = 0; n < tasks.size() && complete; ++n) {
    const auto k = static_cast<int>((first + n) % tasks.size());
    rank(tasks[k], k, key);
    const std::size_t taken = team_.size();
    complete = relations_.team_size(k) >= 0 ? take_tied(tasks[k], k) : take_cheapest(tasks[k], k);
    for (std::size_t p = taken; p < team_.size(); ++p) busy_[team_[p].offer->robot] = 1;
  }
  if (complete) judge(unit);
  for (const Part& part : team_) busy_[part.offer->robot] = 0;
}

// Adds the robots of a task that the same have to do, if all of them can.
bool Placement::take_tied(int task, int k) {
  robots_.clear();
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (keys_[c] == kNever) continue;
    robots_.push_back(candidates_[c]);
    team_.push_back({k, &offers_[k * candidates_.size() + c]});
  }
  return static_cast<int>(robots_.size()) == relations_.team_size(k) && choice_.does(task, robots_);
}

bool Placement::take_cheapest(int task, int k) {
  choose_anew(task);
  const int cheapest = cheapest_team();
  if (cheapest < 0) return false;
  for (const int c : teams_[cheapest]) team_.push_back({k, &offers_[k * candidates_.size() + c]});
  return true;
}

// The teams for a task, whatever was chosen at earlier cuts.
void Placement::choose_anew(int task) {
  TeamChoice::Ranking ranking;
  choice_.teams(task, candidates_, keys_, everyone_, ranking, teams_);
}

int Placement::cheapest_team() const {
  int cheapest = -1;
  double least = kNever;
  for (int t = 0; t < teams_.size(); ++t) {
    double sum = 0.0;
    for (const int c : teams_[t]) sum += keys_[c];
    if (sum >= least) continue;
    least = sum;
    cheapest = t;
  }
  return cheapest;
}

// What it costs that the robots of `team_` do the unit's tasks.
void Placement::judge(int unit) {
  if (looks_ahead_ && !suits(unit)) return;
  const auto tasks = problem_.tasks_of_unit(unit);
  measure_works(tasks.size());
  double begin = ready_;
  for (const Part& part : team_) begin = std::max(begin, part.offer->arrive);
  begin = open_to_team(unit, begin);
  InsertionScore score(problem_.objective(), peak_);
  for (const Part& part : team_) score.add(*part.offer, begin, works_[part.task], growth(part));
  const double value = compared(score.value(begin, timeline_.tail_after(unit, works_), lateness_of_team(unit, begin)));
  if (value >= best_.score || !may_begin(unit, begin)) return;
  for (const Part& part : team_) {
    const int robot = part.offer->robot;
    if (!may_call(robot)) continue;
    const Called called = calls_->with_task(robot, tasks[part.task], part.offer->at, timeline_.works());
    if (called.usage == kNever) return;
  }
  best_.score = value;
  best_.growth = score.growth();
  best_.members.clear();
  for (const Part& part : team_) best_.members.push_back({tasks[part.task], part.offer->robot, part.offer->at});
}

// The work of each task of the unit, as long as for its slowest member.
void Placement::measure_works(std::size_t tasks) {
  works_.assign(tasks, 0.0);
  for (const Part& part : team_) works_[part.task] = std::max(works_[part.task], part.offer->work);
}

// Of a member's usage, which counts the work of its team where usage is time.
double Placement::growth(const Part& part) const {
  const double longer = problem_.usage_is_time() ? works_[part.task] - part.offer->work : 0.0;
  return part.offer->growth + longer;
}

// Whether all that comes after the unit would still be in time, and its members within their capacities.
bool Placement::may_begin(int unit, double begin) const {
  if (!timeline_.in_time(begin, timeline_.latest_for(unit, works_))) return false;
  return std::ranges::all_of(team_, [&](const Part& part) {
    return timeline_.in_time(begin + works_[part.task], part.offer->latest) &&
           problem_.fits(part.offer->robot, part.offer->usage + growth(part));
  });
}

// Of objective `lateness`: what the unit and all that comes after it in its members' routes add.
double Placement::lateness_of_team(int unit, double begin) const {
  if (problem_.objective() != Objective::lateness) return 0.0;
  const auto tasks = problem_.tasks_of_unit(unit);
  double late = 0.0;
  for (const Part& part : team_) late += delays(*part.offer, begin + works_[part.task]);
  for (std::size_t k = 0; k < tasks.size(); ++k) late += lateness(tasks[k], begin + works_[k]);
  return late;
}

}  // namespace muster
