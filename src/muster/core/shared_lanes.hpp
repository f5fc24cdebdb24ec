// Straight lanes between points that robots share, with the points that a robot on a lane comes near.
#pragma once

#include <span>
#include <vector>

#include "lattice.hpp"

namespace muster {

// A point near which a lane or another point lies.
struct Near {
  int point;
  double gap;  // least metres to it
};

class SharedLanes {
 public:
  struct Lane {
    int from, to;
    double length;
    double clearance;  // the largest radius of a robot that may use it
  };

  // `reach_first` has one entry more than there are lanes: the first of a lane's points near it, which are `near`.
  SharedLanes(std::vector<Point> points, std::vector<Lane> lanes, std::vector<int> reach_first, std::vector<Near> near);

  int points() const { return static_cast<int>(points_.size()); }
  int lanes() const { return static_cast<int>(lanes_.size()); }
  Point place(int point) const { return points_[point]; }
  const Lane& lane(int lane) const { return lanes_[lane]; }
  // Lanes that leave a point, and that lead to it.
  std::span<const int> out(int point) const { return span(out_, out_first_, point); }
  std::span<const int> in(int point) const { return span(in_, in_first_, point); }
  // Points that a robot on a lane comes near, its end included, those without that it leaves behind.
  std::span<const Near> reach(int lane) const {
    return {near_.data() + reach_first_[lane], near_.data() + reach_first_[lane + 1]};
  }
  // Points next to a point, itself included, as far as any lane's reach.
  std::span<const Near> around(int point) const {
    return {around_.data() + around_first_[point], around_.data() + around_first_[point + 1]};
  }
  // Radians by which a robot turns from one lane to the next, 0 to pi.
  double turn(int before, int after) const;
  // Direction of a lane, in radians.
  double direction(int lane) const { return directions_[lane]; }

  // Metres to a goal from each point over lanes wide enough for a radius; infinite where there is no way.
  std::vector<double> metres_to(int goal, double radius) const;

 private:
  static std::span<const int> span(const std::vector<int>& all, const std::vector<int>& first, int k) {
    return {all.data() + first[k], all.data() + first[k + 1]};
  }
  void index_ends();
  void find_around();

  std::vector<Point> points_;
  std::vector<Lane> lanes_;
  std::vector<int> reach_first_;
  std::vector<Near> near_;
  std::vector<int> out_, out_first_, in_, in_first_;
  std::vector<Near> around_;
  std::vector<int> around_first_;
  std::vector<double> directions_;
};

}  // namespace muster
