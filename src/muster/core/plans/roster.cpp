#include "plans/roster.hpp"

#include <algorithm>

#include "plans/placement.hpp"

namespace muster {

Roster::Roster(const Problem& problem)
    : problem_(problem),
      timeline_(problem),
      has_fixed_(false),
      weight_(problem.units(), 0.0),
      usage_(problem.robots(), 0.0),
      listed_(problem.units(), 0),
      touched_(problem.robots(), 0),
      holds_(problem.robots(), 1),
      highest_(problem.robots()),
      lowest_(problem.robots()),
      loads_(problem.robots()) {
  if (problem.any_may_run_short()) calls_ = std::make_unique<StationCalls>(problem);
  for (int unit = 0; unit < problem.units(); ++unit) {
    for (const int task : problem.tasks_of_unit(unit)) weight_[unit] += problem.priority(task);
    vanish(unit);
  }
  for (int robot = 0; robot < problem.robots(); ++robot) has_fixed_ |= problem.fixed(robot) > 0;
  placement_ = std::make_unique<Placement>(*this);
}

Roster::~Roster() = default;

bool Roster::begin(const Routes& routes) {
  commit();
  bool possible = timeline_.begin(routes);
  absent_.clear();
  absent_weight_ = 0.0;
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (!present(unit)) vanish(unit);
  }
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    touch(robot);
    measure(robot);
  }
  unmeasured_.clear();
  possible = possible && timeline_.settle() && std::ranges::find(holds_, 0) == holds_.end() && serve();
  commit();
  return possible;
}

bool Roster::ready(int unit) const {
  const auto whole = problem_.inseparable(unit);
  const auto there = [&](int before) {
    const int awaited = problem_.unit(before);
    return present(awaited) || std::ranges::find(whole, awaited) != whole.end();
  };
  const auto all_there = [&](int task) { return std::ranges::all_of(problem_.prerequisites(task), there); };
  const auto is_ready = [&](int each) { return std::ranges::all_of(problem_.tasks_of_unit(each), all_there); };
  return is_ready(unit) && std::ranges::all_of(whole, is_ready);
}

bool Roster::barred(int unit) const {
  if (!problem_.has_exclusive()) return false;
  const auto there = [&](int other) { return present(problem_.unit(other)); };
  const auto task_barred = [&](int task) { return std::ranges::any_of(problem_.exclusive(task), there); };
  const auto is_barred = [&](int each) { return std::ranges::any_of(problem_.tasks_of_unit(each), task_barred); };
  return is_barred(unit) || std::ranges::any_of(problem_.inseparable(unit), is_barred);
}

bool Roster::fixed(int unit) const {
  return has_fixed_ && std::ranges::any_of(timeline_.visits_of(unit), [&](int number) {
           const Visit& visit = timeline_.visit(number);
           return visit.at <= problem_.fixed(visit.robot);
         });
}

const UnitInsertion* Roster::best_insertion(int unit, const Trial& trial) {
  settle();
  return placement_->best(unit, trial);
}

bool Roster::insert(const UnitInsertion& insertion) {
  put_in(insertion);
  for (const PlacedUnit& other : insertion.others) put_in(other);
  return settle_begins();
}

bool Roster::append(int unit, int robot) {
  if (barred(unit)) return false;
  const int last = timeline_.tasks_in(robot);
  const Labels allowed = timeline_.labels_for(unit);
  const double low = std::max(allowed.low, timeline_.stop(robot, last).label);
  if (low >= std::min(allowed.high, timeline_.stop(robot, last + 1).label)) return false;
  put_in({unit, {{problem_.tasks_of_unit(unit).front(), robot, last}}});
  return true;
}

void Roster::put_in(const PlacedUnit& placed) {
  for (const Member& member : placed.members) touch(member.robot);
  timeline_.insert(placed.unit, placed.members, placed.before);
  appear(placed.unit);
  moves_.emplace_back(placed.unit, true);
}

void Roster::remove(int unit) {
  take_out(unit);
  for (const int other : problem_.inseparable(unit)) {
    if (present(other)) take_out(other);
  }
}

void Roster::take_out(int unit) {
  for (const int number : timeline_.visits_of(unit)) touch(timeline_.visit(number).robot);
  timeline_.remove(unit);
  vanish(unit);
  moves_.emplace_back(unit, false);
}

bool Roster::settle() {
  const bool holds = measure_changed();
  return timeline_.settle() && holds;
}

bool Roster::admissible() {
  return serve() && std::ranges::all_of(
                        saved_, [&](const Saved& saved) { return problem_.fits(saved.robot, usage_[saved.robot]); });
}

// --- Figures ---------------------------------------------------------------------------------------------------------

bool Roster::settle_begins() {
  const bool holds = measure_changed();
  return timeline_.settle_begins() && holds;
}

// False: a robot runs short of room or energy.
bool Roster::measure_changed() {
  bool holds = true;
  for (const int robot : unmeasured_) {
    measure(robot);
    holds = holds && holds_[robot];
  }
  unmeasured_.clear();
  return holds;
}

void Roster::measure(int robot) {
  const auto& route = timeline_.route(robot);
  double usage = 0.0;
  for (std::size_t at = 1; at + 1 < route.size(); ++at) {
    const int from = timeline_.visit(route[at - 1]).place, task = timeline_.visit(route[at]).place;
    usage += problem_.travel_usage(robot, from, task);
    usage += problem_.usage_is_time() ? timeline_.work_of(task) : problem_.work_usage(robot, task);
  }
  if (route.size() > 2) usage += problem_.end_usage(robot, timeline_.visit(route[route.size() - 2]).place);
  usage_[robot] = usage;
  holds_[robot] = measure_loads(robot) && call_at_stations(robot);
}

double Roster::peak() {
  if (problem_.objective() == Objective::makespan) return timeline_.end();
  return *std::ranges::max_element(usage_);
}

double Roster::lateness() const {
  double sum = 0.0;
  for (int task = 0; task < problem_.tasks(); ++task) {
    if (!present(problem_.unit(task))) continue;
    sum += problem_.priority(task) * std::max(0.0, timeline_.end_of(task) - problem_.due(task));
  }
  return sum;
}

// Of each task the largest usage on arrival in its team.
double Roster::arrivals() const {
  std::vector<double> arrival(problem_.tasks(), 0.0);
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    const auto& route = timeline_.route(robot);
    const std::span<const Call> calls = calls_ ? std::span<const Call>(calls_->calls(robot)) : std::span<const Call>();
    std::size_t next = 0;
    double usage = 0.0;
    for (std::size_t at = 1; at + 1 < route.size(); ++at) {
      int from = timeline_.visit(route[at - 1]).place;
      const int task = timeline_.visit(route[at]).place;
      for (; next < calls.size() && calls[next].at + 1 == static_cast<int>(at); ++next) {
        const int there = problem_.place_of_station(calls[next].station);
        usage += problem_.travel_usage(robot, from, there);
        from = there;
      }
      usage += problem_.travel_usage(robot, from, task);
      arrival[task] = std::max(arrival[task], usage);
      usage += problem_.usage_is_time() ? timeline_.work_of(task) : problem_.work_usage(robot, task);
    }
  }
  double sum = 0.0;
  for (const double each : arrival) sum += each;
  return sum;
}

double Roster::total() const {
  double total = 0.0;
  for (const double usage : usage_) total += usage;
  return total;
}

double Roster::objective() {
  switch (problem_.objective()) {
    case Objective::total:
      return total();
    case Objective::max:
      return peak();
    case Objective::total_max:
      return total() + peak();
    case Objective::average:
      return arrivals();
    case Objective::makespan:
      return timeline_.end();
    case Objective::lateness:
      return lateness();
  }
  return total();
}

Value Roster::value() {
  int done = problem_.tasks();
  for (const int unit : absent_) done -= static_cast<int>(problem_.tasks_of_unit(unit).size());
  const double objective = this->objective();
  const bool mean = problem_.objective() == Objective::average && done > 0;
  const double tie = problem_.objective() == Objective::lateness ? total() : 0.0;
  return {-absent_weight_, mean ? objective / done : objective, tie};
}

// --- Undo ------------------------------------------------------------------------------------------------------------

void Roster::touch(int robot) {
  if (std::ranges::find(unmeasured_, robot) == unmeasured_.end()) unmeasured_.push_back(robot);
  if (std::exchange(touched_[robot], 1)) return;
  Saved& saved = saved_.emplace_back(robot, usage_[robot], holds_[robot] != 0);
  if (!calls_ || !problem_.may_run_short(robot)) return;
  saved.calls = calls_->calls(robot);
  saved.called = {calls_->usage(robot), calls_->end_s(robot)};
}

void Roster::appear(int unit) {
  absent_[listed_[unit]] = absent_.back();
  listed_[absent_.back()] = listed_[unit];
  absent_.pop_back();
  absent_weight_ = absent_.empty() ? 0.0 : absent_weight_ - weight_[unit];
}

void Roster::vanish(int unit) {
  listed_[unit] = static_cast<int>(absent_.size());
  absent_.push_back(unit);
  absent_weight_ += weight_[unit];
}

void Roster::commit() {
  timeline_.commit();
  for (const Saved& saved : saved_) touched_[saved.robot] = 0;
  saved_.clear();
  moves_.clear();
}

void Roster::rollback() {
  timeline_.rollback();
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
    if (move->second) {
      vanish(move->first);
    } else {
      appear(move->first);
    }
  }
  for (const Saved& saved : saved_) {
    usage_[saved.robot] = saved.usage;
    holds_[saved.robot] = saved.holds;
    touched_[saved.robot] = 0;
    measure_loads(saved.robot);
    if (!calls_ || !problem_.may_run_short(saved.robot)) continue;
    calls_->restore(saved.robot, tasks_of(saved.robot), saved.called, saved.calls);
    set_ways(saved.robot, true);
  }
  saved_.clear();
  moves_.clear();
  unmeasured_.clear();
}

// --- Answers ---------------------------------------------------------------------------------------------------------

Routes Roster::routes() const {
  Routes routes(problem_.robots());
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    for (int at = 1; at <= timeline_.tasks_in(robot); ++at) {
      routes[robot].push_back(timeline_.stop(robot, at).place);
    }
  }
  return routes;
}

std::vector<std::vector<StopTimes>> Roster::stops() const {
  std::vector<std::vector<StopTimes>> stops(problem_.robots());
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    for (int at = 1; at <= timeline_.tasks_in(robot) + 1; ++at) {
      const Visit &last = timeline_.stop(robot, at - 1), &visit = timeline_.stop(robot, at);
      add_calls(robot, at, stops[robot]);
      if (visit.unit < 0) continue;
      stops[robot].push_back({visit.place, last.leave + visit.in, timeline_.begin_of(visit.unit), visit.leave});
    }
  }
  return stops;
}

}  // namespace muster
