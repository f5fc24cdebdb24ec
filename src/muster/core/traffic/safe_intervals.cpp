#include "traffic/safe_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "heap.hpp"
#include "infinity.hpp"

namespace muster {

namespace {

constexpr double kIntervalRounding = 1e-9;
constexpr double kNearly = 1e-6;                // metres by which two may be nearer
constexpr double kRestingInTheWay = 10.0;       // seconds that a path may be longer to rest out of the way
constexpr double kRestingAtAStop = 60.0;        // the same where another has to stop
constexpr std::size_t kMostKnown = 20'000'000;  // edges from which it is known how long goals take

}  // namespace

SafeIntervals::SafeIntervals(std::shared_ptr<const AnnotatedRoadmap> roadmap, std::vector<bool> rests, double margin)
    : roadmap_(std::move(roadmap)),
      rests_(std::move(rests)),
      margin_(margin),
      wanted_(points()),
      stays_(points()),
      passes_(points()),
      safe_(points()),
      known_(points()),
      taken_(roadmap_->graph().edges()),
      known_edge_(roadmap_->graph().edges()),
      by_edge_(roadmap_->graph().edges() + 1),
      by_point_(points()),
      around_(points()) {
  if (static_cast<int>(rests_.size()) != points()) throw std::invalid_argument("rests: expected one for each point");
  find_around();
}

void SafeIntervals::find_around() {
  double reach = 0.0;
  for (int edge = 0; edge < roadmap_->graph().edges(); ++edge)
    for (const auto& near : roadmap_->near(edge)) reach = std::max(reach, near.metres);
  std::vector<int> by_x(points());
  std::iota(by_x.begin(), by_x.end(), 0);
  std::ranges::sort(by_x, {}, [&](int point) { return roadmap_->place(point).x; });
  for (std::size_t first = 0, k = 0; k < by_x.size(); ++k) {
    const Point here = roadmap_->place(by_x[k]);
    while (roadmap_->place(by_x[first]).x < here.x - reach) ++first;
    for (std::size_t j = first; j <= k; ++j) {
      const double gap = distance(here, roadmap_->place(by_x[j]));
      if (gap > reach) continue;
      around_[by_x[k]].push_back({by_x[j], gap});
      if (j < k) around_[by_x[j]].push_back({by_x[k], gap});
    }
  }
}

double& SafeIntervals::Least::at(int row, int state) {
  std::vector<double>& times = rows_[row];
  if (times.empty()) used_.push_back(row);
  if (static_cast<int>(times.size()) <= state) times.resize(state + 1, kNever);
  return times[state];
}

void SafeIntervals::Least::clear() {
  for (const int row : used_) rows_[row].clear();
  used_.clear();
}

void SafeIntervals::clear() {
  for (auto& stays : stays_) stays.clear();
  for (auto& passes : passes_) passes.clear();
  std::ranges::fill(wanted_, 0);
}

void SafeIntervals::want(const Traveller& who) {
  for (const Stop& stop : who.stops) ++wanted_[stop.point];
}

double SafeIntervals::resting(const Traveller& who, int point) const {
  const auto own = std::ranges::count(who.stops, point, &Stop::point);
  if (wanted_[point] > own) return kRestingAtAStop;
  return rests_[point] ? 0.0 : kRestingInTheWay;
}

double SafeIntervals::apart(const Traveller& who, double radius) const {
  return who.radius + radius + margin_ - kNearly;
}

// Half the time that a robot takes to get clear of a point: one that comes is as far away still.
double SafeIntervals::tail(const Traveller& who) const { return (who.radius + margin_) / who.speed; }

SecondsToGoal& SafeIntervals::seconds_to(const Manner& manner, int goal) {
  return seconds_to_goals_.try_emplace({goal, manner}, *roadmap_, manner, goal).first->second;
}

const std::vector<double>& SafeIntervals::metres_to(int goal) {
  return to_goals_.to(goal, [&](int to) { return roadmap_->graph().costs_to(to); });
}

const std::vector<SafeIntervals::Span>& SafeIntervals::safe(const Traveller& who, int point) {
  std::vector<Span>& found = safe_[point];
  if (known_[point]) return found;
  known_[point] = true;
  found.clear();
  const double before = tail(who);
  std::vector<Span> taken;
  for (const auto& near : around_[point])
    for (const Stay& stay : stays_[near.point])
      if (near.metres < apart(who, stay.radius)) taken.push_back({stay.from - before, stay.until});
  for (const Pass& pass : passes_[point])
    if (pass.gap < apart(who, pass.radius)) taken.push_back({pass.start - before, pass.start + before});
  std::ranges::sort(taken, {}, &Span::from);
  double from = -kNever;
  for (const Span& span : taken) {
    if (span.from > from) found.push_back({from, span.from});
    from = std::max(from, span.until);
  }
  if (from < kNever) found.push_back({from, kNever});
  return found;
}

const std::vector<SafeIntervals::Span>& SafeIntervals::taken(const Traveller& who, int edge) {
  std::vector<Span>& found = taken_[edge];
  if (known_edge_[edge]) return found;
  known_edge_[edge] = true;
  found.clear();
  const double before = tail(who);
  for (const auto& near : roadmap_->near(edge))
    for (const Stay& stay : stays_[near.point])
      if (near.metres < apart(who, stay.radius)) found.push_back({stay.from - before, stay.until});
  std::ranges::sort(found, {}, &Span::from);
  std::size_t kept = 0;
  for (const Span& span : found) {
    if (kept > 0 && span.from < found[kept - 1].until - kIntervalRounding)
      found[kept - 1].until = std::max(found[kept - 1].until, span.until);
    else
      found[kept++] = span;
  }
  found.resize(kept);
  return found;
}

double SafeIntervals::earliest(const Traveller& who, int edge, double from, double until) {
  for (const Span& span : taken(who, edge)) {
    if (from <= span.from) break;
    if (from < span.until - kIntervalRounding) from = span.until;
  }
  return from <= until ? from : kNever;
}

double SafeIntervals::leaves_by(const Traveller& who) {
  for (const Span& span : safe(who, who.start))
    if (span.from <= 0.0 && span.until > 0.0) return span.until;
  double until = kNever;  // too near to somebody who stands: only who comes by counts
  for (const Pass& pass : passes_[who.start])
    if (pass.gap < apart(who, pass.radius)) until = std::min(until, pass.start - tail(who));
  return until;
}

std::optional<Way> SafeIntervals::path(const Traveller& who) {
  std::ranges::fill(known_, false);
  std::ranges::fill(known_edge_, false);
  if (seconds_to_goals_.size() * known_edge_.size() > kMostKnown) seconds_to_goals_.clear();
  const DirectedGraph& graph = roadmap_->graph();
  const Manner manner = who.manner();
  const int legs = static_cast<int>(who.stops.size());
  if (legs > 0 && who.stays) {  // where another stays for good nobody can: that is seen without a search
    const std::vector<Span>& at_last = safe(who, who.stops.back().point);
    if (at_last.empty() || at_last.back().until < kNever) return std::nullopt;
  }
  std::vector<SecondsToGoal*> to_stop;
  for (const Stop& stop : who.stops) to_stop.push_back(&seconds_to(manner, stop.point));
  const auto held_after = [&](int leg) { return 0.5 * manner.stopping() + who.stops[leg].hold; };
  std::vector<double> after(legs + 1, 0.0);  // seconds from one stop to when it has held at the last, alone
  for (int leg = legs - 1; leg > 0; --leg)
    after[leg] = to_stop[leg]->from_point(who.stops[leg - 1].point) + held_after(leg) + after[leg + 1];
  double least = who.ready;  // when it can be at a stop, were it alone
  for (int leg = 0; leg < legs; ++leg) {
    least += to_stop[leg]->from_point(leg == 0 ? who.start : who.stops[leg - 1].point) + held_after(leg);
    const std::vector<Span>& at_stop = safe(who, who.stops[leg].point);
    if (at_stop.empty() || at_stop.back().until < least) return std::nullopt;  // others stay there then
  }
  const auto remaining = [&](const Label& label, int point, bool stands) {
    if (label.leg >= legs) return 0.0;
    SecondsToGoal& to = *to_stop[label.leg];
    return (stands ? to.from_point(point) : to.from_edge(label.edge)) + held_after(label.leg) + after[label.leg + 1];
  };

  std::vector<Label> labels;
  struct Item {
    double key;
    int label;
    bool rest;
  };
  // Of each leg: the search keeps to the last leg that it has come to, and goes back where nothing leads on from there.
  // So a delay on one leg is not met by trying all that takes as long on the legs before.
  std::vector<Heap<Item>> queues(legs + 1);
  int leg_now = 0;
  by_edge_.clear();
  by_point_.clear();
  // Who comes this much later in the same interval is no better whatever way it faces.
  const double worst = std::numbers::pi / manner.yaw_rate + 1.5 * manner.stopping();
  const auto stands = [](const Label& label) { return label.edge < 0 || label.start == kNever; };
  const auto offer = [&](Label label, int point) {
    label.key = label.ready + remaining(label, point, stands(label));
    if (!(label.key < kNever)) return;
    const int state = (label.interval + 1) * (legs + 1) + label.leg;
    double &at_point = by_point_.at(point, state), &by_edge = by_edge_.at(label.edge + 1, state);
    if (by_edge <= label.ready + kIntervalRounding || at_point + worst < label.ready) return;
    by_edge = label.ready;
    at_point = std::min(at_point, label.ready);
    labels.push_back(label);
    queues[label.leg].push({label.key, static_cast<int>(labels.size()) - 1, false});
    leg_now = std::max(leg_now, label.leg);
  };
  const Span start{-kNever, leaves_by(who)};
  const auto interval_of = [&](const Label& label) {
    return label.interval < 0 ? start : safe(who, graph.head(label.edge))[label.interval];
  };
  offer({0.0, who.ready, 0, -1, -1, -1, 0.0}, who.start);
  const bool rests = legs == 0 || !who.stays;
  int found = -1, there_first = -1;
  while (leg_now >= 0) {
    if (queues[leg_now].empty()) {
      --leg_now;
      continue;
    }
    const Item item = queues[leg_now].pop();
    const Label label = labels[item.label];
    if (item.rest) {
      found = item.label;
      break;
    }
    if (label.ready > by_edge_.at(label.edge + 1, (label.interval + 1) * (legs + 1) + label.leg)) continue;
    ++expansions_;
    const int point = label.edge < 0 ? who.start : graph.head(label.edge);
    const Span here = interval_of(label);
    if (label.leg < legs && who.stops[label.leg].point == point) {
      const double held = label.ready + held_after(label.leg);
      const bool last = label.leg + 1 == legs;
      if (here.until >= held && (!last || !who.stays || here.until == kNever)) {
        Label on = label;
        on.leg += 1;
        on.ready = held;
        on.parent = item.label;
        on.start = kNever;  // no move
        if (last && there_first < 0) there_first = static_cast<int>(labels.size());
        if (last && who.stays) {
          on.key = held;
          labels.push_back(on);
          queues[legs].push({held, static_cast<int>(labels.size()) - 1, true});
          leg_now = legs;
        } else {
          offer(on, point);
        }
      }
    }
    if (label.leg == legs && rests && here.until == kNever)
      queues[legs].push({label.ready + resting(who, point), item.label, true});
    for (int edge = graph.begin(point); edge < graph.end(point); ++edge) {
      const double angle = label.edge < 0 ? roadmap_->turn_from(who.heading, edge) : roadmap_->turn(label.edge, edge);
      const double turning = stands(label) ? manner.setting_out(angle) : manner.turning(angle);
      const std::vector<Span>& there = safe(who, graph.head(edge));
      for (int k = 0; k < static_cast<int>(there.size()); ++k) {
        const double from = std::max(label.ready + turning, there[k].from),
                     until = std::min(here.until, there[k].until);
        const double set_out = from <= until ? earliest(who, edge, from, until) : kNever;
        if (set_out == kNever) continue;
        const double waited = set_out - label.ready - turning;
        const double arrives = set_out + manner.along(*roadmap_, edge) + std::min(waited, 0.5 * manner.stopping());
        if (arrives > there[k].until) continue;
        offer({0.0, arrives, label.leg, edge, k, item.label, set_out}, graph.head(edge));
      }
    }
  }
  const bool stands_free = found >= 0;
  if (!stands_free) found = there_first;  // nowhere to rest afterwards
  if (found < 0) return std::nullopt;
  Way way{{}, labels[found].ready, stands_free ? kNever : labels[found].ready};
  for (int k = found; k >= 0; k = labels[k].parent) {
    if (legs > 0 && labels[k].leg == legs) way.end = labels[k].ready;
    if (labels[k].edge >= 0 && labels[k].start < kNever)
      way.moves.push_back({labels[k].start, 0, labels[k].edge, labels[k].leg});
  }
  std::ranges::reverse(way.moves);
  return way;
}

Way SafeIntervals::way(const Traveller& who) { return path(who).value_or(Way{{}, kNever, kNever}); }

std::vector<Way> SafeIntervals::in_turn(std::span<const Traveller> travellers, std::span<const SingleMove> moves) {
  struct Progress {
    double ready;
    int point, edge = -1;
    std::size_t leg = 0;
    bool stands = true;
  };
  std::vector<Progress> progress;
  std::vector<Way> ways(travellers.size(), {{}, kNever, kNever});
  const auto stop = [&](int k) {  // passes the stops where it is
    const Traveller& who = travellers[k];
    Progress& now = progress[k];
    const double stopping = 0.5 * who.manner().stopping();
    for (; now.leg < who.stops.size() && who.stops[now.leg].point == now.point; ++now.leg) {
      now.ready += stopping + who.stops[now.leg].hold;
      now.stands = true;
    }
    const bool there = !who.stays || who.stops.empty() || who.stops.back().point == now.point;
    const bool before = ways[k].end < kNever && !who.stays;
    if (now.leg < who.stops.size() || !there)
      ways[k].end = kNever;
    else if (!before || who.stops.empty())
      ways[k].end = now.ready;
  };
  for (int k = 0; k < static_cast<int>(travellers.size()); ++k) {
    const Traveller& who = travellers[k];
    progress.push_back({.ready = who.ready, .point = who.start});
    if (who.fixed) {
      ways[k].end = 0.0;
      continue;
    }
    stays_[who.start].push_back({k, -kNever, kNever, who.radius});
    stop(k);
  }
  for (const auto& [k, edge] : moves) {
    const Traveller& who = travellers[k];
    const Manner manner = who.manner();
    Progress& now = progress[k];
    const double angle = now.edge < 0 ? roadmap_->turn_from(who.heading, edge) : roadmap_->turn(now.edge, edge);
    const double could = now.ready + (now.stands ? manner.setting_out(angle) : manner.turning(angle));
    double start = could;
    for (const auto& near : roadmap_->near(edge))
      for (const Stay& stay : stays_[near.point])
        if (stay.robot != k && near.metres < apart(who, stay.radius)) start = std::max(start, stay.until);
    const int head = roadmap_->graph().head(edge);
    for (const Pass& pass : passes_[head])
      if (pass.robot != k && pass.gap < apart(who, pass.radius)) start = std::max(start, pass.start + tail(who));
    for (Stay& stay : stays_[now.point])
      if (stay.robot == k && stay.until == kNever) stay.until = start + tail(who);
    stays_[head].push_back({k, start, kNever, who.radius});
    for (const auto& near : roadmap_->near(edge)) passes_[near.point].push_back({k, start, near.metres, who.radius});
    ways[k].moves.push_back({start, 0, edge, static_cast<int>(now.leg)});
    now.ready = start + manner.along(*roadmap_, edge) + std::min(start - could, 0.5 * manner.stopping());
    now.point = head;
    now.edge = edge;
    now.stands = false;
    stop(k);
  }
  return ways;
}

void SafeIntervals::reserve(int robot, const Traveller& who, const Way& way) {
  const double after = tail(who);
  int point = who.start;
  double from = -kNever;
  for (const TimedMove& move : way.moves) {
    stays_[point].push_back({robot, from, move.start + after, who.radius});
    for (const auto& near : roadmap_->near(move.edge))
      passes_[near.point].push_back({robot, move.start, near.metres, who.radius});
    point = roadmap_->graph().head(move.edge);
    from = move.start;
  }
  stays_[point].push_back({robot, from, way.until, who.radius});
}

void SafeIntervals::release(int robot, const Traveller& who, const Way& way) {
  erase_stays(robot, who.start);
  for (const TimedMove& move : way.moves) {
    erase_stays(robot, roadmap_->graph().head(move.edge));
    for (const auto& near : roadmap_->near(move.edge))
      std::erase_if(passes_[near.point], [&](const Pass& pass) { return pass.robot == robot; });
  }
}

void SafeIntervals::erase_stays(int robot, int point) {
  std::erase_if(stays_[point], [&](const Stay& stay) { return stay.robot == robot; });
}

void SafeIntervals::reserve_start(int robot, const Traveller& who, double tails) {
  stays_[who.start].push_back({robot, -kNever, who.ready + tails * tail(who), who.radius});
}

std::vector<int> SafeIntervals::meetings(int robot, const Way& way, int robots) const {
  std::vector<int> times(robots, 0);
  for (const TimedMove& move : way.moves)
    for (const auto& near : roadmap_->near(move.edge))
      for (const Stay& stay : stays_[near.point])
        if (stay.robot != robot) ++times[stay.robot];
  return times;
}

}  // namespace muster
