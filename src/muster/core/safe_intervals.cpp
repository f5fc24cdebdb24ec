#include "safe_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "heap.hpp"
#include "random.hpp"

namespace muster {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;
constexpr double kNearly = 1e-6;  // metres by which two may be nearer
constexpr double kTailsToLeave = 4.0;
constexpr int kTriesWhereLost = 4;         // times as many orders are tried where some find no path
constexpr double kRestingInTheWay = 10.0;  // seconds that a path may be longer to rest out of the way

double turned(double from, double to) {
  const double by = std::abs(std::remainder(to - from, 2.0 * std::numbers::pi));
  return std::isnan(by) ? 0.0 : by;
}

}  // namespace

SafeIntervals::SafeIntervals(std::shared_ptr<const AnnotatedRoadmap> roadmap, std::vector<bool> rests, double margin)
    : roadmap_(std::move(roadmap)),
      rests_(std::move(rests)),
      margin_(margin),
      stays_(points()),
      passes_(points()),
      safe_(points()),
      known_(points()),
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

void SafeIntervals::clear() {
  for (auto& stays : stays_) stays.clear();
  for (auto& passes : passes_) passes.clear();
}

double SafeIntervals::apart(const Traveller& who, double radius) const {
  return who.radius + radius + margin_ - kNearly;
}

// Half the time that a robot takes to get clear of a point: one that comes is as far away still.
double SafeIntervals::tail(const Traveller& who) const { return (who.radius + margin_) / who.speed; }

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

double SafeIntervals::earliest(const Traveller& who, int edge, double from, double until) const {
  const double before = tail(who);
  for (bool moved = true; moved && from <= until;) {
    moved = false;
    for (const auto& near : roadmap_->near(edge))
      for (const Stay& stay : stays_[near.point])
        if (near.metres < apart(who, stay.radius) && from > stay.from - before && from < stay.until - kRounding) {
          from = stay.until;
          moved = true;
        }
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

std::optional<SafeIntervals::Way> SafeIntervals::path(const Traveller& who) {
  std::ranges::fill(known_, false);
  const DirectedGraph& graph = roadmap_->graph();
  const int legs = static_cast<int>(who.stops.size());
  std::vector<const std::vector<double>*> to_stop;
  std::vector<double> after(legs + 1, 0.0);  // seconds from a stop to the last
  for (const Stop& stop : who.stops) to_stop.push_back(&metres_to(stop.point));
  if (legs > 0 && who.stays) {  // where another stays for good nobody can: that is seen without a search
    const std::vector<Span>& at_last = safe(who, who.stops.back().point);
    if (at_last.empty() || at_last.back().until < kNever) return std::nullopt;
  }
  for (int leg = legs - 1; leg > 0; --leg)
    after[leg] = after[leg + 1] + (*to_stop[leg])[who.stops[leg - 1].point] / who.speed + who.stops[leg].hold;
  const auto remaining = [&](int leg, int point) {
    return leg >= legs ? 0.0 : (*to_stop[leg])[point] / who.speed + who.stops[leg].hold + after[leg + 1];
  };
  const double stop_s = who.speed / who.acceleration;

  std::vector<Label> labels;
  struct Item {
    double key;
    int label;
    bool rest;
  };
  Heap<Item> queue;
  std::unordered_map<std::uint64_t, double> best;
  const auto offer = [&](Label label, int point) {
    label.key = label.ready + remaining(label.leg, point);
    if (!(label.key < kNever)) return;
    const std::uint64_t key = (static_cast<std::uint64_t>(label.leg) << 52) ^
                              (static_cast<std::uint64_t>(label.edge + 1) << 20) ^
                              static_cast<std::uint64_t>(label.interval);
    const auto [at, fresh] = best.try_emplace(key, label.ready);
    if (!fresh && at->second <= label.ready + kRounding) return;
    at->second = label.ready;
    labels.push_back(label);
    queue.push({label.key, static_cast<int>(labels.size()) - 1, false});
  };
  const Span start{-kNever, leaves_by(who)};
  const auto interval_of = [&](const Label& label) {
    return label.interval < 0 ? start : safe(who, graph.head(label.edge))[label.interval];
  };
  offer({0.0, who.ready, 0, -1, -1, -1, 0.0}, who.start);
  const bool rests = legs == 0 || !who.stays;
  int found = -1, there_first = -1;
  while (!queue.empty()) {
    const Item item = queue.pop();
    const Label label = labels[item.label];
    if (item.rest) {
      found = item.label;
      break;
    }
    const int point = label.edge < 0 ? who.start : graph.head(label.edge);
    const Span here = interval_of(label);
    if (label.leg < legs && who.stops[label.leg].point == point) {
      const double held = label.ready + who.stops[label.leg].hold;
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
          queue.push({held, static_cast<int>(labels.size()) - 1, true});
        } else {
          offer(on, point);
        }
      }
    }
    if (label.leg == legs && rests && here.until == kNever)
      queue.push({label.ready + (rests_[point] ? 0.0 : kRestingInTheWay), item.label, true});
    for (int edge = graph.begin(point); edge < graph.end(point); ++edge) {
      const double angle =
          turned(label.edge < 0 ? who.heading : roadmap_->direction(label.edge), roadmap_->direction(edge));
      const double turning = angle / who.yaw_rate + stop_s * std::min(1.0, angle / (0.5 * std::numbers::pi));
      const std::vector<Span>& there = safe(who, graph.head(edge));
      for (int k = 0; k < static_cast<int>(there.size()); ++k) {
        const double from = std::max(label.ready + turning, there[k].from),
                     until = std::min(here.until, there[k].until);
        const double set_out = from <= until ? earliest(who, edge, from, until) : kNever;
        if (set_out == kNever) continue;
        const double arrives = set_out + roadmap_->length(edge) / who.speed;
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
    const bool leaves = legs > 0 && labels[k].leg == legs;
    if (leaves) way.end = labels[k].ready;
    if (labels[k].edge >= 0 && labels[k].start < kNever) way.moves.push_back({labels[k].start, 0, labels[k].edge, leaves});
  }
  std::ranges::reverse(way.moves);
  return way;
}

void SafeIntervals::reserve(const Traveller& who, const Way& way) {
  const double after = tail(who);
  int point = who.start;
  double from = -kNever;
  for (const TimedMove& move : way.moves) {
    stays_[point].push_back({from, move.start + after, who.radius});
    for (const auto& near : roadmap_->near(move.edge))
      passes_[near.point].push_back({move.start, near.metres, who.radius});
    point = roadmap_->graph().head(move.edge);
    from = move.start;
  }
  stays_[point].push_back({from, way.until, who.radius});
}

Paths SafeIntervals::in_order(std::span<const Traveller> travellers, std::span<const int> order) {
  clear();
  Paths paths{{}, std::vector<double>(travellers.size(), kNever), {order.begin(), order.end()}};
  for (const int k : order)
    if (travellers[k].fixed) reserve(travellers[k], {{}, paths.ends[k] = 0.0, kNever});
  // Those that come later in the order get some time to leave where they start.
  for (const int k : order) {
    const Traveller& who = travellers[k];
    if (!who.fixed) stays_[who.start].push_back({-kNever, who.ready + kTailsToLeave * tail(who), who.radius});
  }
  for (const int k : order) {
    const Traveller& who = travellers[k];
    if (who.fixed) continue;
    std::erase_if(stays_[who.start], [](const Stay& stay) { return stay.from == -kNever; });
    const Way way = path(who).value_or(Way{{}, kNever, kNever});
    paths.ends[k] = way.end;
    reserve(who, way);
    for (TimedMove move : way.moves) {
      move.traveller = k;
      paths.moves.push_back(move);
    }
  }
  std::ranges::stable_sort(paths.moves, {}, &TimedMove::start);
  return paths;
}

Paths SafeIntervals::best_of(std::span<const Traveller> travellers, std::vector<int> order, int tries,
                             std::uint64_t seed) {
  const int n = static_cast<int>(travellers.size());
  Random random(seed);
  Paths best;
  std::pair<int, double> least{n + 1, kNever};
  for (int k = 0; k < tries || (least.first > 0 && k < kTriesWhereLost * tries); ++k) {
    Paths paths = in_order(travellers, order);
    int lost = 0;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) paths.ends[i] < kNever ? void(sum += paths.ends[i]) : void(++lost);
    const std::pair<int, double> cost{lost, sum};
    if (lost > 0) {
      std::ranges::stable_partition(order, [&](int i) { return paths.ends[i] == kNever; });
    } else {
      for (int i = n - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
    }
    if (cost < least) {
      least = cost;
      best = std::move(paths);
    }
  }
  return best;
}

}  // namespace muster
