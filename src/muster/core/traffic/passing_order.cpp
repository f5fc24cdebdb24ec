#include "traffic/passing_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace muster {

namespace {

constexpr double kSample = 0.05;            // metres between the places of a move that are looked at
constexpr double kCorner = 0.02;            // metres before the end of a move at which it is as good as passed
constexpr double kDistanceRounding = 1e-6;  // metres

double side(Point a, Point b, Point p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); }

}  // namespace

double segment_gap(Point p, Point from, Point to) {
  const double dx = to.x - from.x, dy = to.y - from.y, squared = dx * dx + dy * dy;
  const double share = squared > 0.0 ? ((p.x - from.x) * dx + (p.y - from.y) * dy) / squared : 0.0;
  const double kept = std::clamp(share, 0.0, 1.0);
  return distance(p, {from.x + kept * dx, from.y + kept * dy});
}

double segment_gap(Point a_from, Point a_to, Point b_from, Point b_to) {
  const bool apart_by_a = side(a_from, a_to, b_from) * side(a_from, a_to, b_to) >= 0.0;
  const bool apart_by_b = side(b_from, b_to, a_from) * side(b_from, b_to, a_to) >= 0.0;
  if (!apart_by_a && !apart_by_b) return 0.0;
  return std::min({segment_gap(a_from, b_from, b_to), segment_gap(a_to, b_from, b_to),
                   segment_gap(b_from, a_from, a_to), segment_gap(b_to, a_from, a_to)});
}

int PassingOrder::add(Point place, double radius) {
  bots_.push_back({radius, place, 0, 0, {}});
  return static_cast<int>(bots_.size()) - 1;
}

void PassingOrder::stands(int robot, Point place) {
  if (bots_[robot].moves.empty()) bots_[robot].end = place;
}

bool PassingOrder::in_the_way(int robot, Point from, Point to) const {
  for (int other = 0; other < static_cast<int>(bots_.size()); ++other) {
    if (other == robot) continue;
    const Point stands = bots_[other].end;
    const double gap = segment_gap(stands, from, to);
    if (gap < apart(robot, other) - kDistanceRounding && gap < distance(stands, from) - kDistanceRounding) return true;
  }
  return false;
}

std::vector<int> PassingOrder::entered(Point from, Point to) const {
  std::vector<int> found;
  for (int lane = 0; lane < static_cast<int>(lanes_.size()); ++lane)
    if (lanes_[lane].entered(from, to)) found.push_back(lane);
  return found;
}

bool PassingOrder::enters_one_of(const Move& m, const std::vector<int>& lanes) const {
  return std::ranges::any_of(m.enters, [&](int lane) { return std::ranges::find(lanes, lane) != lanes.end(); });
}

template <class On>
int PassingOrder::first_of_full(int lane, int robot, On on) const {
  int count = 0, first = -1;
  for (int other = 0; other < static_cast<int>(bots_.size()); ++other) {
    if (other == robot || !on(lanes_[lane], bots_[other])) continue;
    if (count++ == 0) first = other;
  }
  return count >= lanes_[lane].most() ? first : -1;
}

bool PassingOrder::enters_full_lane(const Move& m) const {
  const auto stands_on = [](const LimitedLane& lane, const Bot& other) { return lane.holds(other.end); };
  return std::ranges::any_of(m.enters, [&](int lane) { return first_of_full(lane, m.robot, stands_on) >= 0; });
}

bool PassingOrder::append(int robot, Point to, int stop, double speed) {
  Bot& bot = bots_[robot];
  const Point from = bot.end;
  if (in_the_way(robot, from, to)) return false;
  Move fresh{.robot = robot,
             .from = from,
             .to = to,
             .length = distance(from, to),
             .stop = stop,
             .speed = speed,
             .enters = entered(from, to),
             .earlier = {}};
  if (enters_full_lane(fresh)) return false;
  for (std::size_t number = first_; number < first_ + moves_.size(); ++number) {
    const Move& before = move(number);
    if (before.robot < 0 || before.robot == robot) continue;
    const bool near = segment_gap(before.from, before.to, from, to) < apart(robot, before.robot);
    if (near || enters_one_of(before, fresh.enters)) fresh.earlier.push_back(number);
  }
  bot.moves.push_back(first_ + moves_.size());
  bot.end = to;
  moves_.push_back(std::move(fresh));
  return true;
}

template <class Stays>
void PassingOrder::drop_after(Bot& bot, Stays stays) {
  while (!bot.moves.empty() && !stays(move(bot.moves.back()))) {
    bot.end = move(bot.moves.back()).from;
    move(bot.moves.back()).robot = -1;
    bot.moves.pop_back();
  }
}

PassingOrder PassingOrder::hold(const std::vector<double>& metres) {
  const auto begun = [](const Move& m) { return m.begun; };
  PassingOrder kept(margin_, ahead_, lanes_);
  kept.first_ = first_;
  kept.bots_ = bots_;
  for (Bot& bot : kept.bots_) {  // where it is when its begun moves are done
    const auto next = std::ranges::find_if(bot.moves, [&](std::size_t number) { return !begun(move(number)); });
    if (next != bot.moves.end()) bot.end = move(*next).from;
    bot.moves.clear();
  }
  std::vector<double> ahead(bots_.size(), 0.0);
  std::vector<char> ended(bots_.size(), false);
  for (std::size_t number = first_; number < first_ + moves_.size(); ++number) {
    Move& m = move(number);
    kept.moves_.push_back({.robot = -1, .enters = {}, .earlier = {}});
    if (m.robot < 0) continue;
    Bot& bot = kept.bots_[m.robot];
    const auto stays = [&](std::size_t e) { return over(e) || move(e).held; };
    m.held = m.begun || (!ended[m.robot] && m.stop <= bot.stop && ahead[m.robot] < metres[m.robot] &&
                         std::ranges::all_of(m.earlier, stays) && !kept.enters_full_lane(m));
    if (!m.held) {
      ended[m.robot] = true;
      continue;
    }
    ahead[m.robot] += m.length - m.at;
    kept.moves_.back() = m;
    bot.moves.push_back(number);
    if (!m.begun) bot.end = m.to;
  }
  holding_ = true;
  return kept;
}

void PassingOrder::adopt(PassingOrder planned) {
  for (Bot& bot : bots_) drop_after(bot, [](const Move& m) { return m.held; });
  for (std::size_t number = first_ + moves_.size(); number < planned.first_ + planned.moves_.size(); ++number) {
    Move& m = planned.move(number);
    bots_[m.robot].moves.push_back(number);
    moves_.push_back(std::move(m));
  }
  for (std::size_t k = 0; k < bots_.size(); ++k) bots_[k].end = planned.bots_[k].end;
  holding_ = false;
  drop_done();
}

void PassingOrder::drop_ahead() {
  for (Bot& bot : bots_) drop_after(bot, [](const Move& m) { return m.begun; });
  while (!moves_.empty() && moves_.back().robot < 0) moves_.pop_back();
}

void PassingOrder::cut() {
  drop_ahead();
  for (Bot& bot : bots_) {
    if (bot.moves.empty()) continue;
    Move& last = move(bot.moves.back());  // those before it are granted whole
    bot.end = last.to = place(last, last.granted);
    last.length = last.granted;
  }
}

void PassingOrder::stop(int robot, Point place) {
  Bot& bot = bots_[robot];
  for (const std::size_t number : bot.moves) move(number).robot = -1;
  bot.moves.clear();
  bot.end = place;
  drop_done();
}

Point PassingOrder::place(const Move& m, double at) const {
  if (at >= m.length) return m.to;
  const double share = at / m.length;
  return {m.from.x + share * (m.to.x - m.from.x), m.from.y + share * (m.to.y - m.from.y)};
}

void PassingOrder::drop_done() {
  while (!moves_.empty() && moves_.front().robot < 0) {
    moves_.pop_front();
    ++first_;
  }
}

void PassingOrder::finish_first(Bot& bot) {
  move(bot.moves.front()).robot = -1;
  bot.moves.pop_front();
  ++bot.passed;
  drop_done();
}

void PassingOrder::progress(int robot, int passed, Point near) {
  Bot& bot = bots_[robot];
  while (bot.passed < passed && !bot.moves.empty()) finish_first(bot);
  for (; !bot.moves.empty(); finish_first(bot)) {
    Move& m = move(bot.moves.front());
    if (!m.begun || m.length <= 0.0) return;
    const double dx = (m.to.x - m.from.x) / m.length, dy = (m.to.y - m.from.y) / m.length;
    const double along = (near.x - m.from.x) * dx + (near.y - m.from.y) * dy;
    m.at = std::clamp(along, m.at, std::max(m.at, m.granted));
    // Where it goes on it need not come back to the end of a move that it has as good as passed.
    if (along < m.length - kCorner || bot.moves.size() < 2 || !move(bot.moves[1]).begun) return;
  }
}

std::pair<double, int> PassingOrder::limit(const Move& m) const {
  double least = m.length;
  int waits_for = -1;
  for (const std::size_t number : m.earlier) {
    if (over(number)) continue;
    const Move& before = move(number);
    const Point from = place(before, before.at);
    const double apart = this->apart(m.robot, before.robot);
    // Places already granted stay granted; from one that is too near the robot may go away.
    double free = std::max(m.at, m.granted), gap = segment_gap(place(m, free), from, before.to);
    while (free < least) {
      const double next = std::min(least, free + kSample);
      const double there = segment_gap(place(m, next), from, before.to);
      if (there < apart && there < gap - kDistanceRounding) {
        least = free;
        waits_for = before.robot;
        break;
      }
      free = next;
      gap = there;
    }
  }
  return {least, waits_for};
}

bool PassingOrder::is_on(const LimitedLane& lane, const Bot& bot) const {
  if (bot.moves.empty()) return lane.holds(bot.end);
  const Move& first = move(bot.moves.front());
  if (lane.holds(place(first, first.at))) return true;
  return std::ranges::any_of(bot.moves, [&](std::size_t number) {
    const Move& m = move(number);
    return m.begun && lane.carries(place(m, m.at), m.to);
  });
}

int PassingOrder::held_up_by(const Move& m) const {
  const auto waiting = std::ranges::find_if(m.earlier, [&](auto e) { return !over(e) && !move(e).begun; });
  if (waiting != m.earlier.end()) return move(*waiting).robot;
  for (const int lane : m.enters) {
    const int first = first_of_full(lane, m.robot, [&](const auto& on, const Bot& bot) { return is_on(on, bot); });
    if (first >= 0) return first;
  }
  return -1;
}

Point PassingOrder::stand(int robot) const {
  const Bot& bot = bots_[robot];
  const auto later = std::ranges::find_if(bot.moves, [&](std::size_t number) { return move(number).stop > bot.stop; });
  return later == bot.moves.end() ? bot.end : move(*later).from;
}

PassingOrder::Grant PassingOrder::grant(int robot) {
  Bot& bot = bots_[robot];
  Grant found{{}, {}, 0, 0.0, -1, true};
  for (const std::size_t number : bot.moves) {
    Move& m = move(number);
    if (m.stop > bot.stop) break;
    if (!m.begun && (found.metres >= ahead_ || (holding_ && !m.held))) {
      found.last = false;
      break;
    }
    const auto [most, waits_for] = limit(m);
    if (!m.begun) {
      const int before = held_up_by(m);
      if (before >= 0 || most < std::min(m.length, kSample)) {
        found.waits_for = before >= 0 ? before : waits_for;
        found.last = false;
        break;
      }
      m.begun = true;
    }
    m.granted = std::max(m.granted, most);
    found.metres += m.granted - m.at;
    found.points.push_back(place(m, m.granted));
    found.speeds.push_back(m.speed);
    if (m.granted < m.length) {
      found.waits_for = waits_for;
      found.last = false;
      break;
    }
    ++found.ended;
  }
  return found;
}

double PassingOrder::metres_left(int robot) const {
  double metres = 0.0;
  for (const std::size_t number : bots_[robot].moves)
    if (move(number).stop <= bots_[robot].stop) metres += move(number).length - move(number).at;
  return metres;
}

}  // namespace muster
