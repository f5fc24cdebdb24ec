// A robot of a simulated crowd: its body, where it is, what it was told, and what was measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "crowd/braking.hpp"
#include "crowd/upright.hpp"
#include "random.hpp"
#include "vectors.hpp"

namespace muster {

constexpr double kBeforeAll = -1.0;  // a time before all others
constexpr double kNoWheels = std::numeric_limits<double>::quiet_NaN();
constexpr double kTrack = 0.287 / 0.3;  // between the wheels, in radii: the Wafflebot's at its inflated radius
constexpr double kNominalRadius = 0.3;  // in place of one of 0

// How a robot comes to its velocity: profiles of speed and turns on the spot, the control laws of [tcf-thesis], or a
// trajectory, which it leaves for profiles where others drive it astray.
enum class Law { profile, thesis, trajectory };

struct Body {
  double radius, speed, yaw_rate, acceleration, priority;
  bool faces_its_way;  // drives only where it looks
  bool flies;
  int walls;  // which set of walls stops it
  Law law = Law::profile;
  double climb = 0.0;  // above 0: it climbs at up to this speed, whatever its speed over ground, by (4.12)
  double climb_rate = std::numeric_limits<double>::infinity();  // up and down along straight ways, else
};

struct Waypoint {
  Vec<3> at;
  double heading;  // NaN: as it arrives
  double hold;
  bool labelled;
  double speed = std::numeric_limits<double>::infinity();  // the greatest on the way to it

  bool stops() const { return hold > 0.0 || !std::isnan(heading); }
};

enum class Phase { idle, going, turning, holding };

// How the place and heading that a robot takes for its own differ from the true ones. What it was told is in the map as
// it believes it to be: `true_of` gives the place to which that leads it.
struct Belief {
  Vec<3> place, believed;
  double turn = 0.0;    // the true heading less the believed one
  double spread = 0.0;  // metres by which it knows that it may be off: one standard deviation

  bool exact() const { return turn == 0.0 && place == believed; }
  Waypoint true_of(const Waypoint& told) const;
  Vec<3> told_of(const Vec<3>& place) const;
};

// What odometry counted in the last step: metres ahead, to the left and up in axes that are level, and amid its turn;
// and radians of that turn. Nothing in it depends on the true heading.
struct Counted {
  Vec<3> way;
  double turn;
};

// Where a robot that follows a trajectory is to be: places and headings each `step` seconds of its clock, as it was
// told them; and the times at which it passes its way points.
struct Reference {
  std::vector<Vec<3>> places;
  std::vector<double> headings, times;
  double step = 0.0, clock = 0.0;
  bool astray = false;                 // it is too far away to follow it
  bool followed = false;               // it follows it in this step
  double ahead = 0.0, yaw_rate = 0.0;  // of one that faces its way, in this step

  bool given() const { return !places.empty(); }
};

// By how much a robot was off its trajectory, over the steps in which it followed it.
struct TrackingErrors {
  double sum = 0.0, most = 0.0;
  long steps = 0;
};

struct CrowdRobot;

// How long a robot has been held up on its way to a way point, and what it tries.
struct Patience {
  double best = std::numeric_limits<double>::infinity();  // least distance to the way point
  double stuck = 0.0;                                     // seconds since it came much nearer, turned aside
  double tilt = 0.0;                                      // radians to the left, of the velocity that it wants
  double until = 0.0;                                     // for which this tilt is tried

  void note(const CrowdRobot& robot, double dt);
  double tilt_at(double time, const Body& body, Random& random);
};

// The way back of a robot that others drove away from the straight piece that it follows: a wall may be between by now.
struct Trail {
  Vec<3> from;                 // where the piece begins
  std::vector<Vec<3>> crumbs;  // places since it was left
  bool back = false;           // whether the robot is on its way back

  void note(const CrowdRobot& robot);
  // Where to go to get back.
  Vec<3> aim(const CrowdRobot& robot) const;
};

struct CrowdRobot {
  Body body;
  Vec<3> position;  // where it would come to a stand, were it told to now
  Vec<3> velocity;  // of the last step
  double heading = 0.0;
  Vec<3> short_of;              // by which its body is not there yet; 0 where it moves exactly as it is told
  double turn_short_of = 0.0;   // the same of its heading
  Vec<3> commanded;             // what it drove by: the velocity without noise
  double ahead = 0.0;           // the same of one that faces its way: speed ahead
  double yaw_rate = 0.0;        // and how fast it turns
  Vec<3> velocity_before;       // of the step before the last
  double heading_before = 0.0;  // of its body, at the beginning of the last step

  std::vector<Waypoint> way;
  std::size_t next = 0;  // of `way`; those before are passed
  int order = 0;
  Phase phase = Phase::idle;
  double hold_until = 0.0;
  std::vector<Waypoint> told;  // the order as it came; `way` is where it leads, by `belief`
  Belief belief;
  Reference reference;
  TrackingErrors errors;
  double slowed = 1.0;
  double exact = 1e-3;  // metres: nearer than this to a place is there
  bool failed = false;
  bool in_traffic = false;  // who orders it says when its way is free: it goes straight, and brakes at most
  bool stopping = false;    // the last order is done or cancelled, and it does not stand yet

  double travelled = 0.0, odometry = 0.0;
  double counts = 1.0;                              // metres by which odometry goes on for a metre of way, in this step
  double turn_counts = 1.0, turns_per_metre = 0.0;  // the same of a turn; and radians that it counts for a metre of way
  double wheel_way = kNoWheels, wheel_turn = kNoWheels;  // by encoders, in this step

  bool turned_aside = false;  // whether in the last step it did not get the velocity that it wanted
  bool braked = false;        // whether the right of way of others was why
  double approach = 0.0;      // m/s by which it comes nearer to its way point, over about the last half second
  Patience patience;
  Trail trail;
  bool arrives = false;             // whether its way point is close by, and nobody on it
  bool waits = false;               // whether another is at work on its way point
  double asked_until = kBeforeAll;  // until then it makes room
  double look_again = kBeforeAll;   // when it looks for a way again after it found none
  std::vector<Vec<3>> aside;        // places by which it makes room or comes back; the last is where it stays
  Vec<3> post;                      // where it stands without an order, and comes back to when it has made room

  Random noise{0}, whims{0}, wheels{0};  // what the world does to it, the tilts that it tries, what its wheels do
  std::vector<Upright> near_faces;
  std::vector<Segment> near_walls;  // the same as avoidance in the plane knows them
  Vec<3> looked_at;                 // where it was when they were collected

  Vec<3> place() const { return position - short_of; }
  double facing() const;  // its body's heading
  double top_speed() const { return body.speed * slowed; }
  // The greatest speed on its way to the next way point.
  double top_speed_here() const { return next < way.size() ? std::min(top_speed(), way[next].speed) : top_speed(); }
  double half_track() const { return 0.5 * kTrack * (body.radius > 0.0 ? body.radius : kNominalRadius); }
  bool under_way() const { return velocity != Vec<3>{}; }
  // It has nothing to do that could not be done elsewhere as well.
  bool has_time() const { return !failed && !in_traffic && body.radius > 0.0 && (phase == Phase::idle || waits); }
  // It makes room, or is not back yet.
  bool is_away(double time) const {
    return phase == Phase::idle && !failed && !in_traffic && body.radius > 0.0 &&
           (asked_until >= time || position != post);
  }
  const Vec<3>& goal() const { return !aside.empty() ? aside.back() : phase == Phase::idle ? post : way[next].at; }
  // It stays where it is whatever comes: at work, out of order, or at its post and not asked to make room.
  bool stands(double time) const {
    if (commanded != Vec<3>{}) return false;
    return failed || phase == Phase::holding || (phase == Phase::idle && !is_away(time));
  }
  // It is moved by others too. Where it holds or turns it stays, also in the step in which it comes to a stand.
  bool gives_way(double time) const {
    return !in_traffic && phase != Phase::holding && phase != Phase::turning && !stands(time);
  }
};

inline double wrapped(double angle) { return std::remainder(angle, 2.0 * std::acos(-1.0)); }

inline Waypoint Belief::true_of(const Waypoint& told) const {
  if (exact()) return told;
  const Vec<3> off = told.at - believed;
  const double c = std::cos(turn), s = std::sin(turn);
  const Vec<3> at = place + Vec<3>{{c * off[0] - s * off[1], s * off[0] + c * off[1], off[2]}};
  return {at, told.heading + turn, told.hold, told.labelled, told.speed};
}

inline Vec<3> Belief::told_of(const Vec<3>& at) const {
  if (exact()) return at;
  const Vec<3> off = at - place;
  const double c = std::cos(turn), s = std::sin(turn);
  return believed + Vec<3>{{c * off[0] + s * off[1], c * off[1] - s * off[0], off[2]}};
}

inline double CrowdRobot::facing() const { return wrapped(heading - turn_short_of); }

}  // namespace muster
