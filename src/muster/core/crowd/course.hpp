// Following way points: the velocity that a robot would have, were it alone, and when it has passed a way point.
#pragma once

#include "crowd/crowd_robot.hpp"

namespace muster {

struct Tolerances {
  double arrival;  // metres from a way point at which a robot counts as there, though it could not get nearer
  double corner;   // metres by which a way point may be cut where the robot goes on
  double heading;  // radians from a heading at which a robot counts as turned to it
};

// Straight to the next way point and on to those after it, as fast as lets it stop at those where it must: where it
// holds or turns, at the last, and at corners that it cannot take. Undisturbed it lands exactly on where it stops.
Vec<3> along_course(const CrowdRobot& robot, const Tolerances& tolerances, double dt);

// A velocity without what of it leads into walls: who errs in where it is goes along them.
Vec<3> along_walls(const CrowdRobot& robot, Vec<3> velocity, double dt);

// As fast as lets it stop there.
Vec<3> straight_to(const CrowdRobot& robot, const Vec<3>& place, double dt);

Vec<3> closest_on_piece(const Vec<3>& p, const Vec<3>& from, const Vec<3>& to);

// Whether the next way point is passed by the step that began at `before`.
bool passes(const CrowdRobot& robot, const Vec<3>& before, Tolerances tolerances, double dt);

}  // namespace muster
