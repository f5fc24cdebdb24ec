// How much energy a robot can have, by when it is there.
#pragma once

#include <algorithm>
#include <array>

#include "plans/timeline.hpp"

namespace muster {

// The most energy that a robot can have at a place by the time at which it is there: concave, rising with time from
// point to point, constant after the last one. Who refills longer is there later. Of many points some are left out,
// which leaves a frontier below the true one.
class Frontier {
 public:
  struct Point {
    double time, energy;
  };

  Frontier() = default;
  Frontier(double time, double energy) : size_(1) { points_[0] = {time, energy}; }

  bool empty() const { return size_ == 0; }
  const Point& first() const { return points_[0]; }
  const Point& last() const { return points_[size_ - 1]; }

  // The most energy at a time that is not before the first point.
  double energy_at(double time) const {
    if (time >= last().time) return last().energy;
    for (int k = size_ - 2; k >= 0; --k) {
      const Point &low = points_[k], &high = points_[k + 1];
      if (time < low.time) continue;
      return low.energy + (high.energy - low.energy) * (time - low.time) / (high.time - low.time);
    }
    return first().energy;
  }
  // The first time with at least so much energy, which is no more than the last point's.
  double time_of(double energy) const {
    if (energy <= first().energy) return first().time;
    for (int k = 1; k < size_; ++k) {
      const Point &low = points_[k - 1], &high = points_[k];
      if (energy > high.energy) continue;
      return low.time + (high.time - low.time) * (energy - low.energy) / (high.energy - low.energy);
    }
    return last().time;
  }

  void advance(double seconds, double energy) {
    for (int k = 0; k < size_; ++k) {
      points_[k].time += seconds;
      points_[k].energy -= energy;
    }
  }
  // Leaves out what has less energy than this.
  void keep_from(double energy) {
    if (size_ == 0 || first().energy >= energy) return;
    if (last().energy < energy) {
      size_ = 0;
      return;
    }
    const double time = time_of(energy);
    drop_until([&](const Point& point) { return point.energy > energy; }, {time, energy});
  }
  // Waits where it is earlier.
  void wait_until(double time) {
    if (size_ == 0 || first().time >= time) return;
    const double energy = energy_at(time);
    drop_until([&](const Point& point) { return point.time > time; }, {time, energy});
  }
  // Leaves out what is later.
  void keep_to(double time) {
    if (size_ == 0 || last().time <= time) return;
    if (first().time > time) {
      size_ = 0;
      return;
    }
    const double energy = energy_at(time);
    while (size_ > 0 && last().time >= time) --size_;
    push({time, energy});
  }

  // The corner at which a slower refill begins: after it waiting here pays more than what is behind it. Of two refills
  // at one rate the later one does, whatever rounding says: tasks between them begin earlier then.
  Point corner(double rate) const {
    int k = 0;
    while (k + 1 < size_ && points_[k + 1].energy - points_[k].energy >
                                rate * (1.0 + kSameRate) * (points_[k + 1].time - points_[k].time)) {
      ++k;
    }
    return points_[k];
  }
  // Refills at a rate, up to a level.
  void refill(double rate, double full) {
    const Point from = corner(rate);
    while (last().time > from.time) --size_;
    if (from.energy < full) push({from.time + (full - from.energy) / rate, full});
  }
  // Refills until it is full.
  void fill(double rate, double full) {
    const Point from = corner(rate);
    *this = Frontier(from.time + std::max(0.0, full - from.energy) / rate, full);
  }

  // Whether it has at least as much energy at every time.
  bool covers(const Frontier& other) const {
    if (first().time > other.first().time) return false;
    for (int k = 0; k < other.size_; ++k) {
      if (energy_at(other.points_[k].time) < other.points_[k].energy) return false;
    }
    return true;
  }

 private:
  static constexpr int kMost = 5;
  static constexpr double kSameRate = 1e-9;

  template <class Behind>
  void drop_until(Behind&& behind, Point first) {
    int k = 0;
    while (k < size_ && !behind(points_[k])) ++k;
    std::array<Point, kMost> rest;
    int kept = 0;
    rest[kept++] = first;
    for (; k < size_ && kept < kMost; ++k) rest[kept++] = points_[k];
    points_ = rest;
    size_ = kept;
  }
  void push(Point point) {
    if (size_ == kMost) {  // the middle is a little lower then
      for (int k = kMost / 2; k + 1 < size_; ++k) points_[k] = points_[k + 1];
      --size_;
    }
    points_[size_++] = point;
  }

  std::array<Point, kMost> points_;
  int size_ = 0;
};

}  // namespace muster
