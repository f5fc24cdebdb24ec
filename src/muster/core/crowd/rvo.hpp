// Reciprocal velocity obstacles as in [tcf-thesis], appendix A3.2, with its symbols; i is the robot that chooses, k
// another.
#pragma once

#include <array>
#include <vector>

#include "crowd/agents.hpp"
#include "crowd/walls.hpp"

namespace muster {

// VO_{i,k} (A.5) with the inflated radii R_i and R_k, whose sum stands for 2 R_i.
class VelocityObstacle {
 public:
  // `yields` is 0.5 between equals, as in (A.5); 1 where robot i gives way alone, with the apex at v_k.
  VelocityObstacle(const Vec<2>& x_i, const Vec<2>& x_k, const Vec<2>& v_i, const Vec<2>& v_k, double radius,
                   double yields);

  // VO^1 to VO^8 (A.5).
  std::array<double, 8> boundaries() const;
  double theta_ik() const { return theta_ik_; }  // (A.6)
  double theta_R() const { return theta_R_; }    // (A.7)
  double phi_delta(const Vec<2>& v) const;       // (A.12)
  double phi_1(const Vec<2>& v) const;           // (A.19)
  // (A.13): phi_delta is not between phi_r and phi_l.
  bool suitable(const Vec<2>& v) const;
  // t_c (A.18), seconds.
  double time_to_collision(const Vec<2>& v) const;

 private:
  Vec<2> x_i_, apex_, ahead_;
  double distance_, radius_;
  double theta_ik_, theta_R_, cos_theta_R_;
};

struct RvoSettings {
  double v_min;         // M_1, m/s
  int magnitudes;       // how many M from M_1 to V_max
  double n;             // step of phi_new, radians
  double w;             // weighting factor of (A.17), metres
  bool ideal;           // whether v_id is a candidate too
  double wall_horizon;  // seconds
  Neighbourhood neighbourhood;
};

// v_opt of every robot, (A.9) to (A.20).
std::vector<Vec<2>> rvo_velocities(const Agents<2>& agents, const std::vector<Segment>& walls,
                                   const RvoSettings& settings, double dt, int threads);

}  // namespace muster
