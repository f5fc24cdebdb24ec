// A world of moving robots in fixed steps of virtual time: way points, kinematics, avoidance, and what is measured.
//
// In a step each robot wants to follow its way points (course), avoidance changes that (ORCA, RVO, HRVO, AVO), its
// kinematics bring it as near to that as they can, and the right of way cuts what could end in a contact.
//
// Either this world moves the robots too (`advance`), exactly as they drive; or something else does, a physics engine:
// then it is told what they are to do (`command`), and tells where that brought them (`carried_out`).
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "crowd/course.hpp"
#include "crowd/crowd_robot.hpp"
#include "crowd/manners.hpp"
#include "crowd/right_of_way.hpp"
#include "crowd/steering.hpp"
#include "crowd/tracking.hpp"

namespace muster {

enum class Avoidance { none, orca, rvo, hrvo, avo };

// What the world does to robots, each a share: of the velocity that they miss (one standard deviation), of the way that
// they slip (at most), of the way by which odometry errs in a step (one standard deviation).
struct CrowdNoise {
  double velocity, slip, odometry;
};

struct CrowdSettings {
  double dt;
  Avoidance avoidance;
  bool space;  // whether those that fly avoid in space
  double horizon, wall_horizon;
  int neighbours;
  double clearance;  // metres that the right of way leaves between robots that move less exactly than they are told
  double margin;     // by which those that face their way are taken for larger, as a share of the radius
  Tolerances tolerances;
  CrowdNoise noise;
  std::uint64_t seed;
};

// A labelled way point was passed, or an order carried out.
struct CrowdEvent {
  double time;
  int robot, order;
  int passed;  // how many way points of the order
  bool idle;   // whether that was the last
};

struct CrowdContact {
  double time, distance;  // when first, and the least distance of centres ever
};

// What a robot is to do in a step.
struct Command {
  Vec<3> velocity;
  double ahead;  // of one that faces its way: its speed
  double yaw_rate;
};

// How a robot moved when a world was left: its velocity, and of one that faces its way its speed ahead and yaw rate.
struct Motion {
  Vec<3> velocity;
  double ahead, yaw_rate;
};

// Where a robot's body is, and by how much it would go on and turn on, were it told to stand now; and the metres and
// radians that its wheels counted in the step, NaN of one without wheels.
struct Carried {
  Vec<3> place, short_of;
  double heading, turn_short_of, counted, turn_counted;
};

// What an inertial unit feels: means between the middles of the last two steps, and over the last one. The axes are
// level, ahead and to the left at its beginning and end on average.
struct Felt {
  Vec<3> acceleration;
  double yaw_rate;
};

class CrowdWorld {
 public:
  explicit CrowdWorld(const CrowdSettings& settings) : settings_(settings) {}

  int add_walls(WallSet walls);
  int add(const Body& body, const Vec<3>& position, double heading);
  // From now on another set of walls stops a robot.
  void set_walls(int i, int walls);

  void send(int i, std::vector<Waypoint> way, int order);
  // The trajectory of the order that was sent last.
  void follow(int i, Reference reference);
  void fail(int i);
  void recover(int i) { robots_[i].failed = false; }
  // Somebody puts a robot elsewhere: it stands there, without an order.
  void place(int i, const Vec<3>& position);
  void slow(int i, double factor) { robots_[i].slowed = factor; }
  void leave_to_traffic(int i) { robots_[i].in_traffic = true; }
  // A world that continues another: its clock, and how each robot moved; none has an order.
  void resume(long steps, const std::vector<Motion>& motions);
  // Where a robot takes itself to be at the end of the last step, and within which spread (metres, one standard
  // deviation). It goes where its way points are by that, until it is told anew. Others, walls and work at a place it
  // perceives from where it is.
  void believe(int i, const Vec<3>& place, double heading, double spread);

  // Steps until a time, or until the end of the first step in which something happened.
  std::vector<CrowdEvent> advance(double until);

  // What robots that something else moves are to do in the next step, noise included; and what happened in it, from
  // where they are at its end. Slower than `still` (m/s) is standing.
  std::vector<Command> command();
  std::vector<CrowdEvent> carried_out(const std::vector<Carried>& after, double still);

  Felt felt(int i) const;
  Counted counted(int i) const;
  // The robot that holds up robot i on the way of its order, -1 where none does: i hardly gets on, as others turn it
  // aside, and this is the nearest ahead, or else the nearest.
  int held_up_by(int i) const;

  double time() const { return settings_.dt * static_cast<double>(steps_); }
  double dt() const { return settings_.dt; }
  long steps() const { return steps_; }
  const std::vector<CrowdRobot>& robots() const { return robots_; }
  double least_distance() const { return least_distance_; }
  const std::map<std::pair<int, int>, CrowdContact>& contacts() const { return contacts_; }

 private:
  void step();
  void look();
  void decide(const AgentTree<3>& tree);
  void conclude(const AgentTree<3>& tree);
  void want(const AgentTree<3>& tree);
  void avoid();
  template <int D>
  void avoid_among(const std::vector<int>& group);
  Vec<3> course(CrowdRobot& robot) const;
  void steer();
  void yield(const AgentTree<3>& tree);
  void disturb(CrowdRobot& robot) const;
  void slip_apart(CrowdRobot& robot) const;
  void move(CrowdRobot& robot) const;
  void measure(const AgentTree<3>& tree);
  void measure(int i, int k);
  void take_note(int i);
  void settle(int i);
  void next_way_point(int i);
  void collect_walls(CrowdRobot& robot) const;

  CrowdSettings settings_;
  std::vector<CrowdRobot> robots_;
  std::vector<WallSet> walls_;
  long steps_ = 0;
  std::vector<Vec<3>> before_, places_before_;    // positions at the beginning of the step, and the bodies' places
  std::vector<Vec<3>> course_, wanted_, chosen_;  // velocities: alone, with manners, with avoidance
  std::vector<Steering> steerings_;
  std::vector<Choice> choices_;
  std::vector<CrowdEvent> events_;
  double least_distance_ = std::numeric_limits<double>::infinity();
  std::map<std::pair<int, int>, CrowdContact> contacts_;
};

}  // namespace muster
