// How far a robot goes that slows down step by step, and how fast it may be to stop within a distance. Velocities are
// constant within a step; from one to the next they change by at most `most * dt`.
#pragma once

#include <algorithm>
#include <cmath>

namespace muster {

struct Braking {
  double dt, most;  // seconds; m/s^2, infinite where nothing limits it

  double slower(double speed) const { return std::max(0.0, speed - most * dt); }

  // In a step at this speed, and in those that follow until it stands.
  double distance(double speed) const {
    const double loss = most * dt;
    if (speed <= loss) return speed * dt;
    const double steps = std::ceil(speed / loss);
    return dt * (steps * speed - loss * steps * (steps - 1.0) / 2.0);
  }

  // The inverse of `distance`.
  double speed(double distance) const {
    if (std::isinf(most)) return distance / dt;
    const double unit = most * dt * dt;
    const double steps = std::max(1.0, std::ceil((std::sqrt(1.0 + 8.0 * distance / unit) - 1.0) / 2.0));
    return (distance / dt + most * dt * steps * (steps - 1.0) / 2.0) / steps;
  }
};

}  // namespace muster
