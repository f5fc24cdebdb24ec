// Following a trajectory: where a robot is to be at each moment, and the speeds that keep it there.
//
// The clock of the trajectory goes on as long as the robot is near its reference, more slowly where it falls behind, as
// it does when others hold it up. A robot that is driven astray goes to its way points as if it had no trajectory, and
// the clock with it, until it is near again.
#pragma once

#include <vector>

#include "crowd/crowd_robot.hpp"

namespace muster {

// The velocity with which the robot follows its trajectory in this step; the clock goes on. For one that faces its way
// its speed ahead and yaw rate are in its reference, too. False: it is to go to its way point without.
bool tracks(CrowdRobot& robot, double dt, Vec<3>& velocity);

// Whether the clock has come to the next way point. True of a robot that follows no trajectory now.
bool clock_is_at(const CrowdRobot& robot);

// Metres between the robot and its reference.
double tracking_error(const CrowdRobot& robot);

}  // namespace muster
