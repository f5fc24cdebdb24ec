#include "crowd/making_room.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "crowd/course.hpp"

namespace muster {

namespace {

constexpr int kClaimedPieces = 2;  // pieces of way that a robot claims
constexpr int kAllAhead = 16;      // that one claims who asks
constexpr int kAround = 32;        // others that are looked at
constexpr double kSpare = 0.1;     // share of both radii by which one stands farther away than it must
constexpr double kContact = 1e-4;
constexpr double kLeastPitch = 0.02;  // metres

// The places that a body can get to, on a lattice around where it is.
class PlaceLattice {
 public:
  PlaceLattice(const CrowdRobot& robot, const WallSet& walls, bool in_space)
      : robot_(robot),
        walls_(walls),
        steps_(in_space ? 9 : 40),
        levels_(in_space ? steps_ : 0),
        pitch_(std::max(kLeastPitch, (in_space ? 1.0 : 0.5) * robot.body.radius)) {
    for (const Upright& face : walls.faces)
      if (norm(face.closest(robot.position) - robot.position) < extent() + robot.body.radius) faces_.push_back(&face);
    clearance_ = std::min(robot.body.radius, clearance(robot.position)) - kContact;
  }

  double extent() const { return 1.5 * steps_ * pitch_; }

  // Nobody gets past this body, but for one that is there already.
  void block(const CrowdRobot& other) {
    const double least = robot_.body.radius + other.body.radius;
    bodies_.push_back({other.position, std::min(least, norm(other.position - robot_.position)) - kContact});
  }

  // The corners of the way to the nearest place that is accepted.
  template <typename Accept>
  std::vector<Vec<3>> nearest(const Accept& accept) const {
    const int wide = 2 * steps_ + 1, high = 2 * levels_ + 1;
    std::vector<int> from(static_cast<std::size_t>(wide) * wide * high, kUnseen);
    const auto index = [&](const Cell& c) { return ((c[2] + levels_) * wide + c[1] + steps_) * wide + c[0] + steps_; };
    std::vector<Cell> found{{0, 0, 0}};
    from[index(found[0])] = kBegin;
    for (std::size_t at = 0; at < found.size(); ++at) {
      const Cell here = found[at];
      if (accept(place(here))) return corners(way(found, from, static_cast<int>(at), index));
      for (const Cell& step : kSteps) {
        const Cell next{here[0] + step[0], here[1] + step[1], here[2] + step[2]};
        if (std::abs(next[0]) > steps_ || std::abs(next[1]) > steps_ || std::abs(next[2]) > levels_) continue;
        if (from[index(next)] != kUnseen) continue;
        from[index(next)] = passable(place(next)) ? static_cast<int>(at) : kBlocked;
        if (from[index(next)] != kBlocked) found.push_back(next);
      }
    }
    return {};
  }

  // Whether the body can go from one place straight to another.
  bool sees(const Vec<3>& from, const Vec<3>& to) const {
    const int pieces = static_cast<int>(std::ceil(norm(to - from) / pitch_));
    for (int k = 1; k <= pieces; ++k)
      if (!passable(from + (static_cast<double>(k) / pieces) * (to - from))) return false;
    return true;
  }

 private:
  using Cell = std::array<int, 3>;
  struct Ball {
    Vec<3> at;
    double radius;
  };
  static constexpr int kUnseen = -1, kBegin = -2, kBlocked = -3;
  static constexpr std::array<Cell, 10> kSteps{{{1, 0, 0},
                                                {0, 1, 0},
                                                {-1, 0, 0},
                                                {0, -1, 0},
                                                {0, 0, 1},
                                                {0, 0, -1},
                                                {1, 1, 0},
                                                {-1, 1, 0},
                                                {-1, -1, 0},
                                                {1, -1, 0}}};

  Vec<3> place(const Cell& cell) const {
    return robot_.position + pitch_ * Vec<3>{{1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]}};
  }

  double clearance(const Vec<3>& p) const {
    double least = std::isfinite(walls_.ground) && p[2] < walls_.ground ? 0.0 : robot_.body.radius;
    for (const Upright* face : faces_) least = std::min(least, norm(face->closest(p) - p));
    for (const Slab& slab : walls_.slabs)
      if (slab.covers(p)) least = std::min(least, norm(slab.closest(p) - p));
    return least;
  }

  bool passable(const Vec<3>& p) const {
    return std::all_of(bodies_.begin(), bodies_.end(), [&](const Ball& b) { return norm(b.at - p) >= b.radius; }) &&
           clearance(p) >= clearance_;
  }

  template <typename Index>
  std::vector<Vec<3>> way(const std::vector<Cell>& found, const std::vector<int>& from, int at,
                          const Index& index) const {
    std::vector<Vec<3>> places;
    for (; at != kBegin; at = from[index(found[at])]) places.push_back(place(found[at]));
    std::reverse(places.begin(), places.end());
    return places;
  }

  // Without the places between which the body can go straight.
  std::vector<Vec<3>> corners(const std::vector<Vec<3>>& places) const {
    std::vector<Vec<3>> kept;
    for (std::size_t at = 0; at + 1 < places.size();) {
      std::size_t next = places.size() - 1;
      while (next > at + 1 && !sees(places[at], places[next])) --next;
      kept.push_back(places[next]);
      at = next;
    }
    return kept;
  }

  const CrowdRobot& robot_;
  const WallSet& walls_;
  int steps_, levels_;
  double pitch_;
  double clearance_ = 0.0;
  std::vector<const Upright*> faces_;
  std::vector<Ball> bodies_;
};

bool moves_on(const CrowdRobot& robot) { return robot.phase == Phase::going && !robot.waits; }

}  // namespace

std::vector<Vec<3>> MakingRoom::aside(int k, int asker) const {
  const CrowdRobot& robot = robots_[k];
  const WallSet& walls = walls_[robot.body.walls];
  PlaceLattice lattice(robot, walls, space_ && robot.body.flies), through = lattice;
  std::vector<int> around;
  tree_.near(k, {kAround, lattice.extent()}, around);
  for (const int j : around) {
    const CrowdRobot& other = robots_[j];
    if (other.body.radius == 0.0 || (moves_on(other) && j != asker)) continue;
    lattice.block(other);
    if (!other.has_time() || j == asker) through.block(other);
  }
  const auto way = lattice.nearest([&](const Vec<3>& place) {
    return !claims(asker, k, place, kAllAhead, kSpare) && std::none_of(around.begin(), around.end(), [&](int j) {
      return claims(j, k, place, kClaimedPieces, kSpare);
    });
  });
  if (!way.empty()) return way;
  return through.nearest([&](const Vec<3>& place) {
    return !claims(asker, k, place, 1, kSpare) &&
           std::none_of(around.begin(), around.end(), [&](int j) { return claims(j, k, place, 0, kSpare); });
  });
}

std::vector<Vec<3>> MakingRoom::way_to(int k, const Vec<3>& place) const {
  const CrowdRobot& robot = robots_[k];
  PlaceLattice lattice(robot, walls_[robot.body.walls], space_ && robot.body.flies);
  std::vector<int> around;
  tree_.near(k, {kAround, lattice.extent()}, around);
  for (const int j : around)
    if (robots_[j].body.radius > 0.0 && !moves_on(robots_[j])) lattice.block(robots_[j]);
  if (lattice.sees(robot.position, place)) return {place};
  auto way = lattice.nearest([&](const Vec<3>& p) { return lattice.sees(p, place); });
  if (!way.empty()) way.push_back(place);
  return way;
}

bool MakingRoom::is_free(int k, const Vec<3>& place) const {
  const double away = norm(place - robots_[k].position), radius = robots_[k].body.radius + largest_radius_;
  std::vector<int> around;
  tree_.near(k, {kAround, away + 4.0 * radius}, around);
  return std::none_of(around.begin(), around.end(), [&](int j) {
    const double reach = away + 4.0 * (robots_[k].body.radius + robots_[j].body.radius);
    return norm(robots_[j].position - robots_[k].position) <= reach && claims(j, k, place, kClaimedPieces, 0.0);
  });
}

bool MakingRoom::claims(int j, int k, const Vec<3>& place, int pieces, double spare) const {
  const CrowdRobot& other = robots_[j];
  const double reach = (1.0 + spare) * (other.body.radius + robots_[k].body.radius);
  if (j == k || other.body.radius == 0.0) return false;
  Vec<3> from = other.position;
  if (norm(from - place) < reach) return true;
  const auto comes_by = [&](const Vec<3>& to) {
    const Vec<3> closest = closest_on_piece(place, from, to);
    from = to;
    return norm(closest - place) < reach;
  };
  if (!other.aside.empty()) return pieces > 0 && std::any_of(other.aside.begin(), other.aside.end(), comes_by);
  for (std::size_t at = other.next; at < other.way.size() && pieces > 0; ++at, --pieces)
    if (comes_by(other.way[at].at)) return true;
  return false;
}

}  // namespace muster
