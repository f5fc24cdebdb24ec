#include "plans/unit_greedy.hpp"

#include <algorithm>

namespace muster {

namespace {

constexpr int kNearUnits = 24;    // tasks near a placed one that are evaluated again
constexpr int kNearRobots = 4;    // that start near a task
constexpr int kMostPlaces = 64;   // beyond it a transport is tried on routes that pass near it
constexpr std::size_t kPart = 8;  // all units are evaluated again when one of so many was placed

bool sees_peak(Objective objective) {
  return objective == Objective::max || objective == Objective::total_max || objective == Objective::makespan;
}

}  // namespace

UnitGreedy::UnitGreedy(Roster& roster, const std::vector<int>& robots, bool thorough)
    : roster_(roster),
      problem_(roster.problem()),
      thorough_(thorough),
      sees_peak_(sees_peak(problem_.objective())),
      robots_(problem_.robots(), 0),
      changed_robots_(problem_.robots(), 0),
      listed_(problem_.units(), 0),
      plain_(problem_.units(), 0),
      kept_(problem_.units()),
      changed_units_(problem_.units(), 0) {
  for (const int robot : robots) robots_.at(robot) = 1;
  everywhere_.append_only = changed_.append_only = true;
  everywhere_.robots = &robots_;
  changed_.robots = &changed_robots_;
  near_ = everywhere_;
  if (!thorough_) {
    neighbours_ = std::make_unique<Neighbours>(problem_, kNearUnits, kNearRobots);
    near_.most_places = kMostPlaces;
    near_.neighbours = neighbours_.get();
  }
  peak_ = roster_.peak();
  relabelings_ = roster_.timeline().relabelings();
  for (int unit = 0; unit < problem_.units(); ++unit) plain_[unit] = is_plain(unit);
  for (int unit = 0; unit < problem_.units(); ++unit) await(unit);
}

UnitGreedy::~UnitGreedy() = default;

// The unit that stands for all that are inseparable from it.
int UnitGreedy::first_of(int unit) const {
  const auto whole = problem_.inseparable(unit);
  return whole.empty() ? unit : *std::ranges::min_element(whole);
}

// Whether one robot does all tasks, whoever does others: what a route offers it does not depend on other routes.
bool UnitGreedy::is_plain(int unit) const {
  const auto is_free = [&](int each) {
    const auto tasks = problem_.tasks_of_unit(each);
    return tasks.size() == 1 && problem_.parts(tasks[0]).empty() && problem_.same_crew(tasks[0]).empty() &&
           problem_.apart(tasks[0]).empty() &&
           (problem_.abilities() == 0 ||
            std::ranges::all_of(problem_.needs(tasks[0]), [](double n) { return n == 0.0; }));
  };
  const auto whole = problem_.inseparable(unit);
  return !problem_.any_may_run_short() && !problem_.has_gap_most() && whole.size() <= 2 && is_free(unit) &&
         std::ranges::all_of(whole, is_free);
}

// Takes a unit up as soon as all that it waits for is in routes.
void UnitGreedy::await(int unit) {
  const int first = first_of(unit);
  if (listed_[first] || roster_.present(first) || !roster_.ready(first)) return;
  listed_[first] = 1;
  ready_.push_back(first);
  evaluate(first, thorough_);
}

// --- What a unit costs -----------------------------------------------------------------------------------------------

void UnitGreedy::evaluate(int unit, bool everywhere) {
  const UnitInsertion* best = roster_.best_insertion(unit, everywhere ? everywhere_ : near_);
  Kept& kept = kept_[unit];
  kept.step = step_;
  kept.found = best != nullptr;
  kept.evaluation = ++evaluations_;
  if (best) keep(unit, *best);
}

// The same, where only routes that a step changed may offer more than those of the kept insertion.
void UnitGreedy::evaluate_changed(int unit) {
  Kept& kept = kept_[unit];
  kept.step = step_;
  if (!any_changed_) return;
  const UnitInsertion* best = roster_.best_insertion(unit, changed_);
  if (!best) return;
  const auto rank = [](const UnitInsertion& one) { return std::pair(one.score, one.members.front().robot); };
  if (kept.found && rank(kept.insertion) < rank(*best)) return;
  kept.found = true;
  kept.evaluation = ++evaluations_;
  keep(unit, *best);
}

void UnitGreedy::keep(int unit, const UnitInsertion& insertion) {
  kept_[unit].insertion = insertion;
  queue_.push({debit(insertion), unit, kept_[unit].evaluation});
}

double UnitGreedy::debit(const UnitInsertion& insertion) const {
  const Objective objective = problem_.objective();
  if (objective == Objective::makespan || objective == Objective::lateness) return insertion.score;
  if (objective == Objective::total) return insertion.growth;
  double most = -kNever;
  const auto look_at = [&](const PlacedUnit& placed) {
    for (const Member& member : placed.members) most = std::max(most, roster_.usage(member.robot));
  };
  look_at(insertion);
  for (const PlacedUnit& other : insertion.others) look_at(other);
  return insertion.growth + most;
}

// --- Steps -----------------------------------------------------------------------------------------------------------

bool UnitGreedy::append_one() {
  std::vector<int> placed;
  for (;;) {
    if (queue_.empty()) {
      if (!evaluate_all_again()) return false;
      continue;
    }
    const Entry entry = queue_.top();
    queue_.pop();
    Kept& kept = kept_[entry.unit];
    if (kept.evaluation != entry.evaluation || !kept.found) continue;
    if (kept.step != step_) {
      evaluate(entry.unit, false);
      continue;
    }
    if (roster_.insert(kept.insertion) && roster_.admissible()) {
      placed.push_back(kept.insertion.unit);
      for (const PlacedUnit& other : kept.insertion.others) placed.push_back(other.unit);
      roster_.commit();
      break;
    }
    roster_.rollback();
    refused_.push_back(entry);
  }
  step_done(placed);
  return true;
}

// Evaluates what is left once more, without leaving out routes. False: nothing fits.
bool UnitGreedy::evaluate_all_again() {
  if (thorough_ || std::exchange(exhausted_, step_) == step_) return false;
  for (const int unit : ready_) evaluate(unit, true);
  refused_.clear();
  return !queue_.empty();
}

void UnitGreedy::step_done(const std::vector<int>& placed) {
  ++step_;
  forget_settled();
  mark_changes();
  for (const Entry& entry : std::exchange(refused_, {})) queue_.push(entry);
  if (thorough_) {
    evaluate_changed_units();
  } else {
    evaluate_near(placed);
  }
  for (const int unit : placed) {
    for (const int task : problem_.tasks_of_unit(unit)) {
      for (const int dependant : problem_.dependants(task)) await(problem_.unit(dependant));
    }
  }
  for (const int unit : std::exchange(marked_units_, {})) changed_units_[unit] = 0;
}

// Units that are in routes, or never will be, as others are there in their place.
void UnitGreedy::forget_settled() {
  std::erase_if(ready_, [&](int unit) {
    if (!roster_.present(unit) && !roster_.barred(unit)) return false;
    kept_[unit].found = false;
    return true;
  });
}

// --- What a step changed ---------------------------------------------------------------------------------------------

void UnitGreedy::mark_changes() {
  const Timeline& timeline = roster_.timeline();
  std::ranges::fill(changed_robots_, 0);
  for (const int unit : timeline.committed()) {
    if (std::exchange(changed_units_[unit], 1)) continue;
    marked_units_.push_back(unit);
    for (const int number : timeline.visits_of(unit)) changed_robots_[timeline.visit(number).robot] = 1;
  }
  add_empty_twins();
  for (std::size_t robot = 0; robot < robots_.size(); ++robot) changed_robots_[robot] &= robots_[robot];
  any_changed_ = std::ranges::find(changed_robots_, 1) != changed_robots_.end();
  const double peak = sees_peak_ ? roster_.peak() : 0.0;
  all_changed_ = timeline.relabelings() != relabelings_ || (sees_peak_ && peak != peak_);
  relabelings_ = timeline.relabelings();
  peak_ = peak;
}

// Of robots that differ in nothing the first without tasks is tried: another one, where that has a task now.
void UnitGreedy::add_empty_twins() {
  const Timeline& timeline = roster_.timeline();
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (timeline.tasks_in(robot) == 0 && problem_.twin(robot) != robot) changed_robots_[robot] = 1;
  }
}

void UnitGreedy::evaluate_changed_units() {
  for (const int unit : ready_) {
    const Kept& kept = kept_[unit];
    const bool anew =
        all_changed_ || !plain_[unit] || depends_on_changes(unit) || (kept.found && uses_changed_robot(kept.insertion));
    if (anew) {
      evaluate(unit, true);
    } else {
      evaluate_changed(unit);
    }
  }
}

// Tasks near those of the step may cost less than before, at the routes that it changed.
void UnitGreedy::evaluate_near(const std::vector<int>& placed) {
  if (++steps_since_all_ > ready_.size() / kPart) {
    steps_since_all_ = 0;
    for (const int unit : ready_) evaluate(unit, false);
    return;
  }
  for (const int unit : placed) {
    for (const int task : problem_.tasks_of_unit(unit)) {
      for (const int near : neighbours_->of(task)) {
        const int other = first_of(problem_.unit(near));
        if (!listed_[other] || roster_.present(other) || kept_[other].step == step_) continue;
        if (plain_[other] && kept_[other].found) {
          const int step = kept_[other].step;
          evaluate_changed(other);
          kept_[other].step = step;
        } else {
          evaluate(other, false);
        }
      }
    }
  }
}

bool UnitGreedy::depends_on_changes(int unit) const {
  const auto changed = [&](int task) { return changed_units_[problem_.unit(task)] != 0; };
  const auto depends = [&](int each) {
    return std::ranges::any_of(problem_.tasks_of_unit(each), [&](int task) {
      return std::ranges::any_of(problem_.prerequisites(task), changed) ||
             std::ranges::any_of(problem_.dependants(task), changed);
    });
  };
  return depends(unit) || std::ranges::any_of(problem_.inseparable(unit), depends);
}

bool UnitGreedy::uses_changed_robot(const UnitInsertion& insertion) const {
  const auto uses = [&](const PlacedUnit& placed) {
    return std::ranges::any_of(placed.members, [&](const Member& m) { return changed_robots_[m.robot] != 0; });
  };
  return uses(insertion) || std::ranges::any_of(insertion.others, uses);
}

}  // namespace muster
