// Places of robots that carry goods, or may have to call at stations.
#include <algorithm>

#include "plans/placement.hpp"

namespace muster {

namespace {

constexpr int kMostJudged = 24;  // places with their calls, the most promising first

}  // namespace

// Whether what a task takes on board, or puts down, fits with all that comes after it.
bool Placement::has_room(int robot, int task, int at) const {
  if (problem_.unloads_at_stations()) return true;  // which is judged with the calls
  for (int c = 0; c < problem_.meters(); ++c) {
    const double load = problem_.load(task, c);
    if (load > 0.0 && !problem_.carries(robot, c, std::max(0.0, roster_.highest_load(robot, at, c) + load)))
      return false;
    if (load < 0.0 && roster_.lowest_load(robot, at, c) + load < -1e-12 * (1.0 - load)) return false;
  }
  return true;
}

// When the robot can leave a stop; with calls as early as it can, as these are chosen anew.
double Placement::leave(int robot, int at) const {
  if (!may_call(robot)) return timeline_.stop(robot, at).leave;
  return calls_->earliest_leave(robot, at, timeline_.works());
}

double Placement::latest_begin(int robot, int at) const {
  if (!may_call(robot)) return timeline_.stop(robot, at).latest;
  return calls_->latest_begin(robot, at - 1, timeline_.works());
}

// The least growth of usage where the robot calls at stations between two stops, and the task may be beside one.
double Placement::growth_beside_calls(int robot, int task, int at) const {
  double least = kNever;
  const Visit& next = timeline_.stop(robot, at + 1);
  const bool goes_on = next.unit >= 0 || problem_.must_end(robot);
  const double work = problem_.work_usage(robot, task);
  int place = timeline_.stop(robot, at).place;
  const auto beside = [&](int from, int to, bool on) {
    double growth = problem_.travel_usage(robot, from, task) + work;
    if (on) growth += problem_.travel_usage(robot, task, to) - problem_.travel_usage(robot, from, to);
    least = std::min(least, growth);
  };
  bool any = false;
  for (const Call& call : calls_->calls(robot)) {
    if (call.at != at) continue;
    any = true;
    beside(place, problem_.place_of_station(call.station), true);
    place = problem_.place_of_station(call.station);
  }
  if (any) beside(place, next.place, goes_on);
  return least;
}

void Placement::keep(Candidate&& candidate) { places_to_judge_.push_back(candidate); }

// The most promising places first, each with the calls that the route needs then, until no other can cost less.
void Placement::judge_candidates() {
  if (places_to_judge_.empty()) return;
  std::ranges::sort(places_to_judge_, {}, &Candidate::score);
  int judged = 0;
  for (const Candidate& candidate : places_to_judge_) {
    if (candidate.score >= best_.score || judged++ >= kMostJudged) break;
    const int robot = candidate.robot;
    const int task = problem_.tasks_of_unit(best_.unit).front();
    const Called called = candidate.second_at < 0 ? calls_->with_task(robot, task, candidate.at, timeline_.works())
                                                  : calls_->with_pair(robot, task, candidate.at, problem_.partner(task),
                                                                      candidate.second_at, timeline_.works());
    if (called.usage == kNever || !problem_.fits(robot, called.usage)) continue;
    const double growth = called.usage - roster_.usage(robot), more = growth - candidate.growth;
    double score = candidate.score;
    switch (problem_.objective()) {
      case Objective::total_max:
        score += more + std::max(0.0, called.usage - peak_) - std::max(0.0, candidate.usage + candidate.growth - peak_);
        break;
      case Objective::max:
        score += InsertionScore::kTie * more + std::max(0.0, called.usage - peak_) -
                 std::max(0.0, candidate.usage + candidate.growth - peak_);
        break;
      case Objective::makespan: {
        const double longer = called.end_s - calls_->end_s(robot) - candidate.takes;
        const double over = std::max(0.0, candidate.ends - peak_);
        score += InsertionScore::kTaken * longer + std::max(over, candidate.ends + longer - peak_) - over;
        break;
      }
      case Objective::average:
        score = called.extra - calls_->extra(robot);
        break;
      case Objective::lateness:
        score = std::max(score, called.extra - calls_->extra(robot)) + InsertionScore::kTie * more;
        break;
      default:
        score += more;
    }
    score = compared(score);
    if (score < best_.score) take(candidate, score, growth);
  }
  places_to_judge_.clear();
}

void Placement::take(const Candidate& candidate, double score, double growth) {
  const int task = problem_.tasks_of_unit(best_.unit).front();
  best_.score = score;
  best_.growth = growth;
  best_.members.assign(1, {task, candidate.robot, candidate.at});
  if (candidate.second_at < 0) return;
  const int partner = problem_.partner(task);
  best_.others.assign(1, {problem_.unit(partner), {{partner, candidate.robot, candidate.second_at + 1}}});
}

}  // namespace muster
