// How near a robot's kinematics bring it to a velocity within one step: holonomic robots and quadcopters at once, those
// that face their way by turning first, or by the law of [tcf-thesis], equations (4.21)-(4.25), while they drive
// (motion/kinematics has the same limits).
#pragma once

#include "crowd/crowd_robot.hpp"

namespace muster {

struct Steering {
  Vec<3> braked, wanted;              // velocities over the step: braking as hard as it can, and as steered
  double ahead_braked, ahead_wanted;  // the same, of the speed ahead of one that faces its way
  double yaw_rate;
  Vec<3> straight, after;  // as in Choice
  double chord = 1.0;
};

// `chosen` is the velocity to get near to; `free`, whether nobody is in the way, so that corners are turned on the
// spot.
Steering steered(const CrowdRobot& robot, const Vec<3>& chosen, bool free, double dt);

}  // namespace muster
