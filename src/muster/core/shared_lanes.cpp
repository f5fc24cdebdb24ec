#include "shared_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace muster {

SharedLanes::SharedLanes(std::vector<Point> points, std::vector<Lane> lanes, std::vector<int> reach_first,
                         std::vector<Near> near)
    : points_(std::move(points)),
      lanes_(std::move(lanes)),
      reach_first_(std::move(reach_first)),
      near_(std::move(near)) {
  const auto known = [&](int point) { return point >= 0 && point < this->points(); };
  for (const Lane& lane : lanes_)
    if (!known(lane.from) || !known(lane.to)) throw std::invalid_argument("a lane leads to a point that is not there");
  for (const Near& near_by : near_)
    if (!known(near_by.point)) throw std::invalid_argument("a lane is near a point that is not there");
  if (reach_first_.size() != lanes_.size() + 1 || reach_first_.front() != 0 ||
      reach_first_.back() != static_cast<int>(near_.size()) || !std::ranges::is_sorted(reach_first_))
    throw std::invalid_argument("reach: expected the first entry of each lane, and their number");
  for (const Lane& lane : lanes_) {
    const Point a = points_[lane.from], b = points_[lane.to];
    directions_.push_back(std::atan2(b.y - a.y, b.x - a.x));
  }
  index_ends();
  find_around();
}

void SharedLanes::index_ends() {
  out_first_.assign(points() + 1, 0);
  in_first_.assign(points() + 1, 0);
  for (const Lane& lane : lanes_) {
    ++out_first_[lane.from + 1];
    ++in_first_[lane.to + 1];
  }
  for (int k = 0; k < points(); ++k) {
    out_first_[k + 1] += out_first_[k];
    in_first_[k + 1] += in_first_[k];
  }
  out_.resize(lanes());
  in_.resize(lanes());
  std::vector<int> out_at = out_first_, in_at = in_first_;
  for (int k = 0; k < lanes(); ++k) {
    out_[out_at[lanes_[k].from]++] = k;
    in_[in_at[lanes_[k].to]++] = k;
  }
}

void SharedLanes::find_around() {
  double reach = 0.0;
  for (const Near& near_by : near_) reach = std::max(reach, near_by.gap);
  const double cell = std::max(reach, 1e-9);
  const auto key = [&](double x, double y) {
    return static_cast<std::int64_t>(std::floor(x / cell)) * 0x100000001LL + static_cast<std::int64_t>(std::floor(y / cell));
  };
  std::unordered_map<std::int64_t, std::vector<int>> cells;
  for (int k = 0; k < points(); ++k) cells[key(points_[k].x, points_[k].y)].push_back(k);
  around_first_.assign(1, 0);
  for (int k = 0; k < points(); ++k) {
    for (const double dx : {-cell, 0.0, cell})
      for (const double dy : {-cell, 0.0, cell})
        if (const auto found = cells.find(key(points_[k].x + dx, points_[k].y + dy)); found != cells.end())
          for (const int other : found->second)
            if (const double gap = distance(points_[k], points_[other]); gap <= reach) around_.push_back({other, gap});
    around_first_.push_back(static_cast<int>(around_.size()));
  }
}

double SharedLanes::turn(int before, int after) const {
  const double turned = std::abs(directions_[after] - directions_[before]);
  return std::min(turned, 2.0 * std::numbers::pi - turned);
}

std::vector<double> SharedLanes::metres_to(int goal, double radius) const {
  std::vector<double> metres(points(), std::numeric_limits<double>::infinity());
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  metres[goal] = 0.0;
  queue.emplace(0.0, goal);
  while (!queue.empty()) {
    const auto [far, point] = queue.top();
    queue.pop();
    if (far > metres[point]) continue;
    for (const int k : in(point)) {
      if (lanes_[k].clearance < radius) continue;
      const double farther = far + lanes_[k].length;
      if (farther < metres[lanes_[k].from]) queue.emplace(metres[lanes_[k].from] = farther, lanes_[k].from);
    }
  }
  return metres;
}

}  // namespace muster
